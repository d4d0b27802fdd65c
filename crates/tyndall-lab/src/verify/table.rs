//! Tables of reference numbers: lines of `#` are comments, the first other line names the columns.

use std::collections::{BTreeMap, HashMap};

/// A row, by the names of its columns.
#[derive(Debug, Clone)]
pub(crate) struct Row<'a>(HashMap<&'a str, &'a str>);

impl Row<'_> {
    /// The words of a column; none where it is empty or does not exist.
    pub(crate) fn word(&self, column: &str) -> &str {
        self.0.get(column).copied().unwrap_or("")
    }

    /// The number of a column; not a number where there is none.
    pub(crate) fn number(&self, column: &str) -> f64 {
        self.word(column).parse().unwrap_or(f64::NAN)
    }
}

/// All rows of a table.
pub(crate) fn rows(text: &str) -> Vec<Row<'_>> {
    let mut lines = text.lines().filter(|line| !line.starts_with('#') && !line.trim().is_empty());
    let columns: Vec<&str> = lines.next().unwrap_or("").split(',').collect();
    lines.map(|line| Row(columns.iter().copied().zip(cells(line)).collect())).collect()
}

/// The cells of a line; commas between quotes belong to the cell.
fn cells(line: &str) -> impl Iterator<Item = &str> {
    let mut quoted = false;
    let is_border = move |c: char| {
        quoted ^= c == '"';
        c == ',' && !quoted
    };
    line.split(is_border).map(|cell| cell.trim_matches('"'))
}

/// Rows of one key each, in the order of the keys.
pub(crate) fn grouped<'r, 'a, K: Ord>(
    rows: &'r [Row<'a>],
    key: impl Fn(&'r Row<'a>) -> K,
) -> BTreeMap<K, Vec<&'r Row<'a>>> {
    let mut groups: BTreeMap<K, Vec<&Row>> = BTreeMap::new();
    for row in rows {
        groups.entry(key(row)).or_default().push(row);
    }
    groups
}

/// The ends of the bins `r_lo` to `r_hi`, increasing.
pub(crate) fn edges(rows: &[&Row]) -> Vec<f64> {
    let mut edges: Vec<f64> = rows.iter().flat_map(|row| [row.number("r_lo"), row.number("r_hi")]).collect();
    edges.sort_by(f64::total_cmp);
    edges.dedup();
    edges
}
