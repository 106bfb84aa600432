//! A job worked in ranges and put together again.

use foothold::gcode::assemble;
use foothold::pipeline::{Finished, Job, RangeResult, Share};

/// The file when each of `cuts` (ascending, from 0 to the number of layers) begins a range, each
/// range worked by `work`.
pub fn file(
    mut job: Job,
    cuts: &[usize],
    work: impl Fn(&Job, usize, usize) -> RangeResult,
) -> (Vec<u8>, Finished) {
    let results: Vec<RangeResult> = cuts.windows(2).map(|w| work(&job, w[0], w[1])).collect();
    let mut texts = Vec::new();
    for result in results {
        job.add(result.meta);
        texts.extend(result.texts);
    }
    let finished = job.finish(&|| 0.0).expect("all layers are there");
    (assemble(&finished.joined, &texts), finished)
}

/// A range worked by the engine that holds the job.
pub fn own(job: &Job, first: usize, last: usize) -> RangeResult {
    job.slice(first, last, &|| 0.0)
}

/// A range as another engine gets it: through bytes.
pub fn shared(job: &Job, first: usize, last: usize) -> RangeResult {
    let bytes = postcard::to_allocvec(&job.share(first, last)).expect("it can be written");
    let share: Share = postcard::from_bytes(&bytes).expect("it can be read");
    share.slice(&|| 0.0)
}
