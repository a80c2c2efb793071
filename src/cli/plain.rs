//! Plain: text from outside, such that it does nothing to a terminal.

/// The most characters that a message has.
const LONGEST: usize = 2000;

/// How many of them come from its end.
const END: usize = 400;

/// A message with control characters, and those that change the direction of
/// writing or have no width, as their escapes; cut in the middle if it is very
/// long. Whatever a file, a path or an argument puts into a message, all
/// messages go through here.
pub fn plain(message: &str) -> String {
    let mut text = String::with_capacity(message.len());
    for character in message.chars() {
        if acts_on_terminals(character) {
            text.extend(character.escape_default());
        } else {
            text.push(character);
        }
    }
    let count = text.chars().count();
    if count <= LONGEST {
        return text;
    }
    let head = text.chars().take(LONGEST - END);
    head.chain(" […] ".chars()).chain(text.chars().skip(count - END)).collect()
}

/// Whether a character does something instead of being seen.
pub fn acts_on_terminals(character: char) -> bool {
    character.is_control()
        || matches!(
            character,
            '\u{ad}'
                | '\u{61c}'
                | '\u{200b}'..='\u{200f}'
                | '\u{2028}'..='\u{202e}'
                | '\u{2060}'..='\u{206f}'
                | '\u{feff}'
                | '\u{fff9}'..='\u{fffb}'
                | '\u{e0000}'..='\u{e007f}'
        )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_acts_on_a_terminal_is_escaped_and_the_rest_stays() {
        assert_eq!(plain("\u{1b}[2Jα \"β\"\n\u{9b}m"), "\\u{1b}[2Jα \"β\"\\n\\u{9b}m");
        assert_eq!(plain("a\u{202e}b\u{200b}"), "a\\u{202e}b\\u{200b}");
    }

    #[test]
    fn long_messages_are_cut_in_the_middle() {
        let message = format!("begin {} end", "x".repeat(1_000_000));
        let cut = plain(&message);
        assert!(cut.starts_with("begin x") && cut.ends_with("x end"));
        assert_eq!(cut.chars().count(), LONGEST + 5);
    }
}
