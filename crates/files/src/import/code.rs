//! Start and end code: placeholders of other slicers to ours.

/// Names there and here.
pub(crate) type Placeholders = &'static [(&'static str, &'static str)];

/// The code with our placeholders, or why it cannot be: what is not known must not be guessed in code
/// that drives heaters. `\n` of one-line formats becomes a line feed.
pub(crate) fn translated(code: &str, names: Placeholders) -> Result<String, String> {
    let mut out = String::with_capacity(code.len());
    for line in unescaped(code).lines() {
        let (command, comment) = line.split_at(line.find(';').unwrap_or(line.len()));
        translate(command, names, &mut out)?;
        out.extend(comment.chars().filter(|c| !"{}".contains(*c)));
        out.push('\n');
    }
    Ok(out)
}

fn translate(command: &str, names: Placeholders, out: &mut String) -> Result<(), String> {
    let mut rest = command;
    while let Some(at) = rest.find(['{', '[', '}']) {
        let close = if rest.as_bytes()[at] == b'{' { '}' } else { ']' };
        out.push_str(&rest[..at]);
        let inner = &rest[at + 1..];
        let Some(end) = inner.find(close) else { return Err(unknown(rest)) };
        // `{temperature[0]}` and `{temperature[initial_tool]}` ask for one tool's value.
        let end = if close == '}' {
            end
        } else {
            inner.rfind(']').filter(|_| inner[..end].contains('[')).unwrap_or(end)
        };
        let word = &inner[..end];
        let name = word.split('[').next().unwrap_or_default().trim();
        let ours = names.iter().find(|(theirs, _)| *theirs == name).ok_or_else(|| unknown(word))?.1;
        out.push_str(&format!("{{{ours}}}"));
        rest = &inner[end + 1..];
    }
    out.push_str(rest);
    Ok(())
}

fn unknown(word: &str) -> String {
    let short: String = word.trim().chars().take(60).collect();
    format!("its placeholder \"{short}\" has no counterpart here; our own code is kept")
}

fn unescaped(code: &str) -> String {
    let code = code.strip_prefix('"').and_then(|c| c.strip_suffix('"')).unwrap_or(code);
    code.replace("\\n", "\n").replace("\\\"", "\"").replace('\r', "")
}
