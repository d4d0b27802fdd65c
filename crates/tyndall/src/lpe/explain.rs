//! An expression in words.

use super::{Events, Expr, Expression, Item, Letters};

/// What an expression selects, a step of the path a line.
pub fn explain(expr: &Expression) -> String {
    let mut lines = Vec::new();
    for (i, pattern) in expr.all.iter().enumerate() {
        if i > 0 {
            lines.push("and at once".to_owned());
        }
        steps(pattern, 0, &mut lines);
    }
    lines.join("\n")
}

fn steps(expr: &Expr, depth: usize, lines: &mut Vec<String>) {
    let indent = "  ".repeat(depth);
    match expr {
        Expr::Event(events) => lines.push(format!("{indent}{}", phrase(events))),
        Expr::Sequence(parts) if parts.is_empty() => lines.push(format!("{indent}nothing")),
        Expr::Sequence(parts) => {
            for part in parts {
                steps(part, depth, lines);
            }
        }
        Expr::Either(parts) => {
            lines.push(format!("{indent}one of these:"));
            for (i, part) in parts.iter().enumerate() {
                if i > 0 {
                    lines.push(format!("{indent}or"));
                }
                steps(part, depth + 1, lines);
            }
        }
        Expr::Repeat { of, least, most } => {
            let times = times(*least, *most);
            match &**of {
                Expr::Event(events) => lines.push(format!("{indent}{times}: {}", phrase(events))),
                other => {
                    lines.push(format!("{indent}{times}:"));
                    steps(other, depth + 1, lines);
                }
            }
        }
    }
}

fn times(least: u32, most: Option<u32>) -> String {
    match (least, most) {
        (0, None) => "any number of times, or never".into(),
        (0, Some(1)) => "once or not at all".into(),
        (1, None) => "once or more".into(),
        (n, None) => format!("{n} times or more"),
        (1, Some(1)) => "once".into(),
        (0, Some(0)) => "never".into(),
        (n, Some(m)) if n == m => format!("{n} times"),
        (n, Some(m)) => format!("{n} to {m} times"),
    }
}

fn phrase(events: &Events) -> String {
    // Letters without names are one thing to say, however they were written.
    let plain = events.items.iter().filter(|item| item.name.is_none());
    let letters = plain.fold(Letters::NONE, |all, item| all.or(item.letters));
    let named = events.items.iter().filter(|item| item.name.is_some());
    if events.negated && events.items.iter().all(|item| item.name.is_none()) {
        return said(&words(letters.others()));
    }
    let all: Vec<_> = words(letters).into_iter().chain(named.map(with_name)).collect();
    let all = said(&all);
    if events.negated { format!("anything but {all}") } else { all }
}

fn said(words: &[String]) -> String {
    if words.is_empty() { "nothing".into() } else { words.join(" or ") }
}

fn with_name(item: &Item) -> String {
    let name = item.name.as_ref().map_or("", |name| &name.text);
    format!("{} called '{name}'", said(&words(item.letters)))
}

/// Letters in as few words as they need.
fn words(letters: Letters) -> Vec<String> {
    const TURNS: Letters = Letters(0b111_1111);
    if letters == Letters::ALL {
        return vec!["anything".into()];
    }
    let mut words = Vec::new();
    let rest = if letters.include(TURNS) {
        words.push("any scattering".to_owned());
        letters.and(TURNS.others())
    } else {
        words.extend(surfaces(letters));
        letters
    };
    let single = [
        (Letters::V, "scattering in a medium"),
        (Letters::L, "a light"),
        (Letters::O, "matter that glows"),
        (Letters::B, "the background"),
        (Letters::C, "the camera"),
    ];
    words.extend(single.iter().filter(|(letter, _)| rest.include(*letter)).map(|(_, word)| (*word).to_owned()));
    words
}

/// What surfaces do: kinds that both ways have in common are said once.
fn surfaces(letters: Letters) -> Vec<String> {
    let kinds = |of: Letters, shift: usize| of.0 >> shift & 0b111;
    let (reflected, transmitted) = (kinds(letters, 0), kinds(letters, 3));
    let both = reflected & transmitted;
    let ways = [
        (both, "reflection or transmission"),
        (reflected & !both, "reflection"),
        (transmitted & !both, "transmission"),
    ];
    let say = |(kinds, way): (u16, &str)| {
        let names = ["sharp", "glossy", "diffuse"];
        let named: Vec<_> = (0..3).filter(|k| kinds >> k & 1 == 1).map(|k| names[k]).collect();
        match named.len() {
            0 => None,
            3 => Some(format!("{way} at a surface")),
            _ => Some(format!("{} {way} at a surface", named.join(" or "))),
        }
    };
    ways.into_iter().filter_map(say).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lpe::parse;

    #[test]
    fn expressions_are_said_in_words() {
        let say = |text: &str| explain(&parse(text).unwrap());
        assert_eq!(
            say("C[RT]*V[LOB]"),
            "the camera\nany number of times, or never: reflection or transmission at a surface\n\
             scattering in a medium\na light or matter that glows or the background"
        );
        assert_eq!(say("C<RD>S+L'lamp'").lines().nth(1), Some("diffuse reflection at a surface"));
        assert_eq!(say("CS+L").lines().nth(1), Some("once or more: sharp reflection or transmission at a surface"));
        assert_eq!(say("C.[^V]B").lines().nth(1), Some("anything"));
        assert!(say("C[^V'milk']B").contains("anything but scattering in a medium called 'milk'"));
        assert_eq!(say("C[^.]B").lines().nth(1), Some("nothing"));
        assert_eq!(say("[RTV]"), "any scattering");
        assert_eq!(say("<[^R]S>"), "sharp transmission at a surface");
        assert_eq!(say("C(V|R){2}B").lines().nth(1), Some("2 times:"));
        assert_eq!(say("V&B"), "scattering in a medium\nand at once\nthe background");
    }
}
