//! From the text of an expression to what it says.

use super::{Events, Expr, ExprError, Expression, Item, Letters, Name};

/// Parentheses within each other.
const DEEPEST: usize = 32;
/// Repetitions that are counted.
const MOST_TIMES: u32 = 1000;
/// Bytes of an expression.
const LONGEST: usize = 4096;

/// Reads an expression.
///
/// # Errors
/// What is wrong with it, and where.
pub fn parse(text: &str) -> Result<Expression, ExprError> {
    if text.len() > LONGEST {
        return Err(error(LONGEST, format!("an expression has at most {LONGEST} bytes")));
    }
    let mut reader = Reader { text, at: 0, depth: 0 };
    let mut all = vec![reader.alternatives()?];
    while reader.take('&') {
        all.push(reader.alternatives()?);
    }
    match reader.peek() {
        None => Ok(Expression { all }),
        Some(_) => Err(error(reader.at, "this parenthesis closes nothing")),
    }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

impl Reader<'_> {
    /// The next character that is no space.
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    fn take(&mut self, wanted: char) -> bool {
        let found = self.peek() == Some(wanted);
        if found {
            self.at += wanted.len_utf8();
        }
        found
    }

    /// `a|b`
    fn alternatives(&mut self) -> Result<Expr, ExprError> {
        let mut parts = vec![self.sequence()?];
        while self.take('|') {
            parts.push(self.sequence()?);
        }
        Ok(if parts.len() == 1 { parts.remove(0) } else { Expr::Either(parts) })
    }

    /// `ab`
    fn sequence(&mut self) -> Result<Expr, ExprError> {
        let mut parts = Vec::new();
        while let Some(c) = self.peek() {
            if matches!(c, '&' | '|' | ')') {
                break;
            }
            let one = self.one()?;
            parts.push(self.repeated(one)?);
        }
        Ok(if parts.len() == 1 { parts.remove(0) } else { Expr::Sequence(parts) })
    }

    /// `(…)`, `[…]` or an event.
    fn one(&mut self) -> Result<Expr, ExprError> {
        self.peek();
        let start = self.at;
        if self.take('(') {
            if self.depth == DEEPEST {
                return Err(error(start, format!("more than {DEEPEST} parentheses within each other")));
            }
            self.depth += 1;
            let inside = self.alternatives()?;
            self.depth -= 1;
            if self.peek() == Some('&') {
                let help = "alternatives are grouped by parentheses, not what must hold at once";
                return Err(error(self.at, "`&` joins whole expressions").help(help));
            }
            if !self.take(')') {
                return Err(error(start, "this parenthesis is never closed"));
            }
            return Ok(inside);
        }
        if self.take('[') {
            return self.set(start).map(Expr::Event);
        }
        Ok(Expr::Event(Events { items: vec![self.item()?], negated: false }))
    }

    /// What follows `[`.
    fn set(&mut self, start: usize) -> Result<Events, ExprError> {
        let negated = self.take('^');
        let mut items = Vec::new();
        while !self.take(']') {
            if self.peek().is_none() {
                return Err(error(start, "this bracket is never closed"));
            }
            items.push(self.item()?);
        }
        if items.is_empty() {
            return Err(error(start, "these brackets hold nothing").help("[RT] is either of the two"));
        }
        Ok(Events { items, negated })
    }

    /// `R`, `V'milk'`, `<RD'wall'>`, `'milk'`.
    fn item(&mut self) -> Result<Item, ExprError> {
        self.peek();
        let start = self.at;
        if self.take('<') {
            let of = self.position(EVENTS, "an event")?;
            let closed = |c: Option<char>| matches!(c, None | Some('>' | '\'' | '"'));
            let kinds = if closed(self.peek()) { None } else { Some(self.position(KINDS, "a kind")?) };
            let name = self.name()?;
            if !self.take('>') {
                return Err(error(start, "this angle is never closed").help("<RD> is a reflection that is diffuse"));
            }
            let letters = kinds.map_or(of, |kinds| of.and(kinds));
            if letters == Letters::NONE {
                let help = "R and T have kinds, as in <RD>; write V, L, O and B without";
                return Err(error(start, "there is no such event").help(help));
            }
            return Ok(Item { letters, name });
        }
        if let Some(name) = self.name()? {
            return Ok(Item { letters: Letters::ALL, name: Some(name) });
        }
        let letters = self.letter(&[EVENTS, &KINDS[..3]].concat(), "an event")?;
        // The camera has no name: one behind it is an event of its own.
        let name = if letters == Letters::C { None } else { self.name()? };
        Ok(Item { letters, name })
    }

    /// One of the two places between angles: a letter, or several in brackets.
    fn position(&mut self, known: &[(char, Letters)], what: &str) -> Result<Letters, ExprError> {
        self.peek();
        let start = self.at;
        if !self.take('[') {
            return self.letter(known, what);
        }
        let negated = self.take('^');
        let mut letters = Letters::NONE;
        while !self.take(']') {
            if self.peek().is_none() {
                return Err(error(start, "this bracket is never closed"));
            }
            letters = letters.or(self.letter(known, what)?);
        }
        Ok(if negated { letters.others() } else { letters })
    }

    fn letter(&mut self, known: &[(char, Letters)], what: &str) -> Result<Letters, ExprError> {
        let Some(c) = self.peek() else {
            return Err(error(self.at, format!("{what} is missing at the end")));
        };
        let Some((_, letters)) = known.iter().find(|(letter, _)| *letter == c) else {
            return Err(self.no_letter(c, known, what));
        };
        self.at += c.len_utf8();
        Ok(*letters)
    }

    fn no_letter(&self, c: char, known: &[(char, Letters)], what: &str) -> ExprError {
        let upper = c.to_ascii_uppercase();
        let help = if matches!(c, '*' | '+' | '?' | '{') {
            "it repeats what stands before it, and nothing does: .* is any number of events".into()
        } else if c != upper && known.iter().any(|(letter, _)| *letter == upper) {
            format!("did you mean {upper}?")
        } else {
            let letters: Vec<_> = known.iter().map(|(letter, _)| letter.to_string()).collect();
            format!("known are {}; names stand in quotes, as in V'milk'", letters.join(" "))
        };
        error(self.at, format!("`{c}` is not {what}")).help(help)
    }

    /// `'milk'` or `"milk"`, if one stands here.
    fn name(&mut self) -> Result<Option<Name>, ExprError> {
        let Some(quote @ ('\'' | '"')) = self.peek() else { return Ok(None) };
        let start = self.at;
        let rest = &self.text[start + 1..];
        let Some(length) = rest.find(quote) else {
            return Err(error(start, "this quote is never closed"));
        };
        self.at = start + length + 2;
        Ok(Some(Name { text: rest[..length].to_owned(), at: start }))
    }

    /// `*`, `+`, `?`, `{2,4}`, as many as there are.
    fn repeated(&mut self, mut of: Expr) -> Result<Expr, ExprError> {
        loop {
            let (least, most) = match self.peek() {
                Some('*') => (0, None),
                Some('+') => (1, None),
                Some('?') => (0, Some(1)),
                Some('{') => {
                    let (least, most) = self.times()?;
                    of = Expr::Repeat { of: Box::new(of), least, most };
                    continue;
                }
                _ => return Ok(of),
            };
            self.at += 1;
            of = Expr::Repeat { of: Box::new(of), least, most };
        }
    }

    /// `{2}`, `{2,}`, `{2,4}`.
    fn times(&mut self) -> Result<(u32, Option<u32>), ExprError> {
        let start = self.at;
        let rest = &self.text[start + 1..];
        let inside = rest.split_once('}').map(|(inside, _)| inside);
        let number = |text: &str| text.trim().parse::<u32>().ok().filter(|n| *n <= MOST_TIMES);
        let times = inside.and_then(|inside| match inside.split_once(',') {
            None => number(inside).map(|n| (n, Some(n))),
            Some((least, most)) if most.trim().is_empty() => Some((number(least)?, None)),
            Some((least, most)) => Some((number(least)?, Some(number(most)?))),
        });
        match (times, inside) {
            (Some((least, most)), Some(inside)) if most.is_none_or(|most| least <= most) => {
                self.at = start + inside.len() + 2;
                Ok((least, most))
            }
            _ => Err(error(start, "this is no number of times")
                .help(format!("write {{2}}, {{2,}} or {{2,4}}, up to {MOST_TIMES}"))),
        }
    }
}

const EVENTS: &[(char, Letters)] = &[
    ('C', Letters::C),
    ('R', Letters::R),
    ('T', Letters::T),
    ('V', Letters::V),
    ('L', Letters::L),
    ('O', Letters::O),
    ('B', Letters::B),
    ('.', Letters::ALL),
];
const KINDS: &[(char, Letters)] = &[('S', Letters::S), ('G', Letters::G), ('D', Letters::D), ('.', Letters::ALL)];

pub(super) fn error(at: usize, message: impl Into<String>) -> ExprError {
    ExprError { at, message: message.into(), help: None }
}

impl ExprError {
    /// Adds what to do.
    #[must_use]
    pub(super) fn help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }

    /// The message, the expression with a mark beneath the place, and what to do.
    pub fn shown(&self, text: &str) -> String {
        let before = text.get(..self.at).unwrap_or(text).chars().count();
        let help = self.help.as_ref().map(|help| format!("\n  help: {help}")).unwrap_or_default();
        // The expression stands on one line, whatever its white space.
        let line: String = text.chars().map(|c| if c.is_whitespace() { ' ' } else { c }).collect();
        format!("{}\n    {line}\n    {:before$}^{help}", self.message, "")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn fault(text: &str) -> (usize, String) {
        let error = parse(text).unwrap_err();
        (error.at, error.shown(text))
    }

    #[test]
    fn what_is_wrong_is_pointed_at() {
        for (text, at, says) in [
            ("CX", 1, "`X` is not an event"),
            ("C v L", 2, "did you mean V?"),
            ("C(RL", 1, "never closed"),
            ("CR)L", 2, "closes nothing"),
            ("C[RL", 1, "never closed"),
            ("C[]L", 1, "hold nothing"),
            ("C<VD>L", 1, "without"),
            ("C<RDL", 1, "never closed"),
            ("C<R'a", 3, "never closed"),
            ("*C", 0, "nothing does"),
            ("CV{3,2}L", 2, "no number of times"),
            ("CV{x}L", 2, "no number of times"),
            ("CV{2000}L", 2, "up to 1000"),
            ("CV'milkL", 2, "never closed"),
            ("Cé", 1, "`é` is not an event"),
            ("C<", 2, "missing"),
            ("C(R&T)L", 3, "joins whole"),
        ] {
            let (found, message) = fault(text);
            assert!(found == at && message.contains(says), "{text}: {found} {message}");
        }
    }

    #[test]
    fn what_is_nested_or_long_without_end_is_an_error_and_no_panic() {
        assert!(fault(&"(".repeat(4000)).1.contains("within each other"));
        assert!(fault(&"C".repeat(5000)).1.contains("at most"));
        assert!(parse("").is_ok() && parse("C|").is_ok());
    }
}
