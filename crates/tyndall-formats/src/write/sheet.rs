//! A sheet of indented lines.

/// Text in the making.
#[derive(Default)]
pub(super) struct Sheet {
    text: String,
    depth: usize,
}

impl Sheet {
    /// One line, or an empty one.
    pub(super) fn line(&mut self, words: &str) {
        if !words.is_empty() {
            self.text.extend(std::iter::repeat_n("  ", self.depth));
            self.text.push_str(words);
        }
        self.text.push('\n');
    }

    /// An empty line, unless there is one or the sheet is empty.
    pub(super) fn gap(&mut self) {
        if !self.text.is_empty() && !self.text.ends_with("\n\n") {
            self.text.push('\n');
        }
    }

    /// What follows stands further in.
    pub(super) fn indent(&mut self) {
        self.depth += 1;
    }

    /// What follows stands further out.
    pub(super) fn outdent(&mut self) {
        self.depth = self.depth.saturating_sub(1);
    }

    /// All of it.
    pub(super) fn into_text(self) -> String {
        self.text
    }
}
