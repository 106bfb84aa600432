//! The lines of a job from its text in pieces.

/// Bytes of a line that are kept; more than any line that can be sent. The rest of a longer one is read
/// and thrown away, so that a file without line feeds takes no more memory than another.
const MAX_RAW_LINE: usize = 4096;

/// Lines of a text that comes in pieces of any size, without their line feeds. `pull` gives the next piece
/// and `None` at the end; it is called when a line is wanted and none is at hand.
pub fn lines_of<P, F>(mut pull: F) -> impl Iterator<Item = Vec<u8>>
where
    P: AsRef<[u8]>,
    F: FnMut() -> Option<P>,
{
    let mut piece: Option<P> = None;
    let mut at = 0;
    let mut ended = false;
    std::iter::from_fn(move || {
        let mut line: Option<Vec<u8>> = None;
        while !ended {
            let rest = piece.as_ref().and_then(|p| p.as_ref().get(at..)).unwrap_or_default();
            if rest.is_empty() {
                piece = pull();
                at = 0;
                ended = piece.is_none();
                continue;
            }
            let end = rest.iter().position(|b| *b == b'\n');
            let part = end.map_or(rest, |end| &rest[..end]);
            let line = line.get_or_insert_default();
            let room = MAX_RAW_LINE.saturating_sub(line.len());
            line.extend_from_slice(&part[..part.len().min(room)]);
            at += part.len() + usize::from(end.is_some());
            if end.is_some() {
                break;
            }
        }
        line
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(pieces: &[&str]) -> Vec<String> {
        let mut pieces = pieces.iter();
        lines_of(|| pieces.next()).map(|line| String::from_utf8(line).expect("text")).collect()
    }

    #[test]
    fn pieces_may_end_anywhere() {
        let whole = lines(&["G1 X1\n\nG1 X2\nG1 X3"]);
        assert_eq!(whole, ["G1 X1", "", "G1 X2", "G1 X3"]);
        assert_eq!(lines(&["G1", " X1\n", "", "\n", "G1 X2", "\nG1 X3", ""]), whole);
        assert_eq!(lines(&["G1 X1\n", ""]), ["G1 X1"]);
        assert!(lines(&[]).is_empty() && lines(&["", ""]).is_empty());
    }

    #[test]
    fn an_endless_line_is_cut_and_the_next_one_is_whole() {
        let mut pieces = (0..100_000).map(|_| "x".repeat(64)).chain(["\nG28\n".to_owned()]);
        let got: Vec<Vec<u8>> = lines_of(|| pieces.next()).collect();
        assert_eq!((got[0].len(), got[0].capacity()), (MAX_RAW_LINE, MAX_RAW_LINE));
        assert_eq!(got[1..], [b"G28".to_vec()]);
    }
}
