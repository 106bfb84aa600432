//! Trains the network that picks the directions with the least support (`src/orientation/net.rs`).
//!
//! ```text
//! cargo run --release --example train_orientation            # print the metrics
//! cargo run --release --example train_orientation -- --write # and write src/orientation/weights.bin
//! ```
//!
//! A tiny dense network with Adam [Kingma and Ba 2015] in plain f64, one seed, no clock, no
//! threads: every machine gets the same bytes. `tests/orientation_network.rs` runs [`train`] too.

use foothold::orientation::exact;
use foothold::orientation::net::{DIRECTIONS, HIDDEN, Net, ScaledVolumes, WEIGHTS};

/// Seed of the stored weights.
pub const SEED: u64 = 0x0F00_7401;

/// Adam steps of the full training.
pub const STEPS: usize = 60_000;

/// Rows looked at in one step.
const BATCH: usize = 256;

/// Step size of Adam at the start; it falls to zero as (1 - x)^2. With 0.02 the network ends far
/// from its best (89 % of the clear cases), with 0.8 a direction's units die (80 %).
const RATE: f64 = 0.3;

/// Weights of the inputs start within this: telling a gap of a thousandth takes steep units, and
/// from 1 they grow too slowly.
const FIRST_INPUT_WEIGHT: f64 = 20.0;

/// Where the two smallest differ by more than this share of the largest, the network is scored.
const CLEAR_GAP: f64 = 0.01;

/// Closer than this, but not equal, and a case is left out of training: no small network tells such
/// a gap from a tie. Far below [`CLEAR_GAP`], for the third volume of a tie may be that near too.
const TRAINED_GAP: f64 = 5e-4;

fn main() {
    let net = train(SEED, STEPS);
    let metrics = measure(&net, SEED + 1, 100_000);
    println!("{metrics:#?}");
    if std::env::args().any(|a| a == "--write") {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/src/orientation/weights.bin");
        std::fs::write(path, net.to_bytes()).expect("weights.bin can be written");
        println!("wrote {path}");
    }
}

/// How often the network gives the exact answer, all six outputs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metrics {
    /// Cases whose two smallest volumes differ by more than 1 % of the largest.
    pub clear_cases: usize,
    /// Share of them answered exactly.
    pub clear: f64,
    /// Share of all drawn cases answered exactly, the unclear ones included.
    pub all: f64,
    /// Share of cases with two to six equal smallest volumes answered exactly.
    pub ties: f64,
}

/// Scores a network on fresh cases: `count` drawn ones and `count` with exact ties.
pub fn measure(net: &Net, seed: u64, count: usize) -> Metrics {
    let mut random = Random(seed);
    let (mut clear_cases, mut clear, mut all, mut ties) = (0, 0, 0, 0);
    for i in 0..count {
        let volumes = draw(&mut random, i % 2 == 1);
        let right = is_right(net, volumes);
        all += usize::from(right);
        if gap(&volumes) > CLEAR_GAP {
            clear_cases += 1;
            clear += usize::from(right);
        }
        let tied = tie(&mut random, volumes);
        ties += usize::from(is_right(net, tied));
    }
    let share = |n: usize, of: usize| n as f64 / of.max(1) as f64;
    Metrics {
        clear_cases,
        clear: share(clear, clear_cases),
        all: share(all, count),
        ties: share(ties, count),
    }
}

fn is_right(net: &Net, volumes: [f64; DIRECTIONS]) -> bool {
    let scaled = ScaledVolumes::new(volumes).expect("drawn volumes are finite and positive");
    net.minima(&scaled) == exact::minima(&volumes)
}

/// Difference of the two smallest volumes in shares of the largest.
fn gap(volumes: &[f64; DIRECTIONS]) -> f64 {
    let mut sorted = *volumes;
    sorted.sort_by(f64::total_cmp);
    (sorted[1] - sorted[0]) / sorted[DIRECTIONS - 1]
}

/// Six volumes, mm3, largest possible 1e5: uniform, or log-uniform over three decades.
pub fn draw(random: &mut Random, logarithmic: bool) -> [f64; DIRECTIONS] {
    std::array::from_fn(|_| {
        let share = random.share();
        1e5 * if logarithmic { libm::exp(-3.0 * std::f64::consts::LN_10 * share) } else { share }
    })
}

/// The same case with the smallest volume copied to one to five other places.
pub fn tie(random: &mut Random, mut volumes: [f64; DIRECTIONS]) -> [f64; DIRECTIONS] {
    let smallest = (1..DIRECTIONS).fold(0, |s, i| if volumes[i] < volumes[s] { i } else { s });
    for _ in 0..1 + random.below(DIRECTIONS - 1) {
        let other = (smallest + 1 + random.below(DIRECTIONS - 1)) % DIRECTIONS;
        volumes[other] = volumes[smallest];
    }
    volumes
}

/// The same case with the second smallest volume brought near the smallest, but still clear of it.
fn near(random: &mut Random, mut volumes: [f64; DIRECTIONS]) -> [f64; DIRECTIONS] {
    let mut order: [usize; DIRECTIONS] = std::array::from_fn(|i| i);
    order.sort_by(|&a, &b| volumes[a].total_cmp(&volumes[b]));
    let largest = volumes[order[DIRECTIONS - 1]];
    volumes[order[1]] = volumes[order[0]] + largest * TRAINED_GAP * (1.0 + 3.0 * random.share());
    volumes
}

/// One training row and whether its first volume is a minimum.
fn draw_row(random: &mut Random) -> ([f64; DIRECTIONS], f64) {
    loop {
        let drawn = draw_even(random);
        let volumes = match random.below(3) {
            0 => drawn,
            1 => tie(random, drawn),
            _ => near(random, drawn),
        };
        let exact = exact::minima(&volumes);
        let tied = exact.iter().filter(|&&o| o == 1).count() > 1;
        if tied || gap(&volumes) > TRAINED_GAP {
            // Half of the rows ask for a minimum, half for another volume.
            let wanted = u8::from(random.below(2) == 1);
            let places: Vec<usize> = (0..DIRECTIONS).filter(|&i| exact[i] == wanted).collect();
            if let Some(&i) = places.get(random.below(places.len().max(1))) {
                let scaled = ScaledVolumes::new(volumes).expect("drawn volumes are finite and positive");
                return (scaled.row(i), f64::from(wanted));
            }
        }
    }
}

fn draw_even(random: &mut Random) -> [f64; DIRECTIONS] {
    let logarithmic = random.below(2) == 1;
    draw(random, logarithmic)
}

/// Trains from random weights; the same seed and number of steps give the same network.
pub fn train(seed: u64, steps: usize) -> Net {
    let mut random = Random(seed);
    let mut weights = first_weights(&mut random);
    let mut adam = Adam { mean: [0.0; WEIGHTS], square: [0.0; WEIGHTS] };
    for step in 0..steps {
        let mut slope = [0.0; WEIGHTS];
        for _ in 0..BATCH {
            let (row, wanted) = draw_row(&mut random);
            add_slope(&weights, &row, wanted, &mut slope);
        }
        let left = 1.0 - step as f64 / steps as f64;
        adam.step(&mut weights, &slope, step + 1, RATE * left * left);
    }
    Net::from_weights(weights.map(|w| w as f32))
}

/// Uniform within +-[`FIRST_INPUT_WEIGHT`] and, at the output, +-1/4; biases 0.
fn first_weights(random: &mut Random) -> [f64; WEIGHTS] {
    let inputs = HIDDEN * DIRECTIONS;
    std::array::from_fn(|i| match i {
        i if i < inputs => FIRST_INPUT_WEIGHT * (2.0 * random.share() - 1.0),
        i if (inputs + HIDDEN..inputs + 2 * HIDDEN).contains(&i) => 0.5 * random.share() - 0.25,
        _ => 0.0,
    })
}

/// Adds the slope of the cross entropy of one row, over all weights, to `slope`.
fn add_slope(weights: &[f64; WEIGHTS], row: &[f64; DIRECTIONS], wanted: f64, slope: &mut [f64; WEIGHTS]) {
    let (biases, outputs) = (HIDDEN * DIRECTIONS, HIDDEN * DIRECTIONS + HIDDEN);
    let drive: [f64; HIDDEN] = std::array::from_fn(|h| {
        let inputs = &weights[h * DIRECTIONS..(h + 1) * DIRECTIONS];
        inputs.iter().zip(row).fold(weights[biases + h], |s, (w, v)| s + w * v)
    });
    let evidence =
        (0..HIDDEN).fold(weights[WEIGHTS - 1], |s, h| s + weights[outputs + h] * drive[h].max(0.0));
    let error = (1.0 / (1.0 + libm::exp(-evidence)) - wanted) / BATCH as f64;
    slope[WEIGHTS - 1] += error;
    for h in 0..HIDDEN {
        if drive[h] > 0.0 {
            slope[outputs + h] += error * drive[h];
            let back = error * weights[outputs + h];
            slope[biases + h] += back;
            for (j, v) in row.iter().enumerate() {
                slope[h * DIRECTIONS + j] += back * v;
            }
        }
    }
}

/// Running means of slope and squared slope.
struct Adam {
    mean: [f64; WEIGHTS],
    square: [f64; WEIGHTS],
}

impl Adam {
    fn step(&mut self, weights: &mut [f64; WEIGHTS], slope: &[f64; WEIGHTS], count: usize, rate: f64) {
        const KEEP: (f64, f64) = (0.9, 0.999);
        // Start-up corrections; past 10,000 steps they are 1 to the last bit that matters.
        let power = |base: f64| 1.0 - (0..count.min(10_000)).fold(1.0, |p, _| p * base);
        let (fix_mean, fix_square) = (power(KEEP.0), power(KEEP.1));
        for i in 0..WEIGHTS {
            self.mean[i] = KEEP.0 * self.mean[i] + (1.0 - KEEP.0) * slope[i];
            self.square[i] = KEEP.1 * self.square[i] + (1.0 - KEEP.1) * slope[i] * slope[i];
            weights[i] -= rate * (self.mean[i] / fix_mean) / ((self.square[i] / fix_square).sqrt() + 1e-10);
        }
    }
}

/// SplitMix64 [Steele, Lea, Flood 2014].
pub struct Random(pub u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number in [0, 1).
    pub fn share(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number in 0..n, n > 0.
    pub fn below(&mut self, n: usize) -> usize {
        (self.share() * n as f64) as usize
    }
}
