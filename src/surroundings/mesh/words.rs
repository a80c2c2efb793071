//! Words: text as the readers of mesh files see it, each word with its line.

use super::MeshError;

/// The words of a text, one after another.
pub(super) struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
    /// The line that the place is on.
    here: usize,
    /// The line of the last word.
    line: usize,
}

impl<'a> Words<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, here: 1, line: 1 }
    }

    /// The line of the last word, from 1.
    pub(super) fn line(&self) -> usize {
        self.line
    }

    fn skip_space(&mut self) {
        while let Some(byte) = self.bytes.get(self.at).filter(|byte| byte.is_ascii_whitespace()) {
            self.here += usize::from(*byte == b'\n');
            self.at += 1;
        }
    }

    /// Whether no word follows.
    pub(super) fn is_at_end(&mut self) -> bool {
        self.skip_space();
        self.at == self.bytes.len()
    }

    /// The next word and its line.
    pub(super) fn next(&mut self) -> Option<(usize, &'a [u8])> {
        self.skip_space();
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        if end == 0 {
            return None;
        }
        self.at += end;
        self.line = self.here;
        Some((self.here, &rest[..end]))
    }

    /// Passes over the rest of a line.
    pub(super) fn end_line(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
    }

    /// Takes a word, in letters of any size.
    pub(super) fn expect(&mut self, wanted: &str) -> Result<(), MeshError> {
        let quoted = format!("\"{wanted}\"");
        match self.next() {
            Some((_, word)) if word.eq_ignore_ascii_case(wanted.as_bytes()) => Ok(()),
            Some((line, word)) => Err(unexpected(line, word, &quoted)),
            None => Err(self.ends_before(&quoted)),
        }
    }

    /// Takes a number that `is_fine`.
    pub(super) fn number(&mut self, is_fine: impl Fn(f64) -> bool) -> Result<f64, MeshError> {
        match self.next() {
            Some((line, word)) => number(line, word, is_fine),
            None => Err(self.ends_before("a number")),
        }
    }

    fn ends_before(&self, wanted: &str) -> MeshError {
        MeshError::at_line(self.line, format!("the file ends here, where {wanted} belongs"))
    }
}

/// A number that `is_fine`.
pub(super) fn number(
    line: usize,
    word: &[u8],
    is_fine: impl Fn(f64) -> bool,
) -> Result<f64, MeshError> {
    let parsed = str::from_utf8(word).ok().and_then(|word| word.parse::<f64>().ok());
    match parsed {
        Some(value) if is_fine(value) => Ok(value),
        Some(_) => {
            let problem = format!("{}, where a finite number belongs", shown(word));
            Err(MeshError::at_line(line, problem))
        }
        None if word.contains(&b',') => {
            let wanted = "a number, with a point before its decimals";
            Err(unexpected(line, word, wanted))
        }
        None => Err(unexpected(line, word, "a number")),
    }
}

/// The error of a word where another one belongs.
pub(super) fn unexpected(line: usize, word: &[u8], wanted: &str) -> MeshError {
    MeshError::at_line(line, format!("{} stands where {wanted} belongs", shown(word)))
}

/// A word as messages show it.
fn shown(word: &[u8]) -> String {
    /// More is no word.
    const MOST: usize = 40;
    let text = String::from_utf8_lossy(&word[..word.len().min(MOST)]).into_owned();
    if word.len() > MOST { format!("{text:?}…") } else { format!("{text:?}") }
}
