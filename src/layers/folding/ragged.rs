//! A list of numbers for every pixel of a box, of which most are empty.

/// Pixels along the sides of tiles in which lists are made; also how many share an entry of [`Ragged`].
pub const TILE: usize = 16;

/// A list of numbers for every pixel of a box, row by row. Which pixels have any is known by bits, so that the others
/// take no more memory than these.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ragged {
    /// One for [`TILE`] pixels each, and one more.
    runs: Vec<Run>,
    /// Where each list that is not empty ends.
    ends: Vec<u32>,
    values: Vec<f64>,
}

/// Neighboring pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Run {
    /// How many lists there are before these pixels.
    before: u32,
    /// Which of them have one, the first by the lowest bit.
    has: u16,
}

impl Ragged {
    /// The list of each pixel.
    pub fn new<'a>(lists: impl IntoIterator<Item = &'a [f64]>) -> Self {
        let (mut ragged, mut pixels) = (Ragged::default(), 0);
        for list in lists {
            ragged.push(pixels, list);
            pixels += 1;
        }
        ragged.ended(pixels)
    }

    /// Adds the list of pixel `i`, which is behind all those that have one; [`Ragged::ended`] must follow.
    pub fn push(&mut self, i: usize, list: &[f64]) {
        if list.is_empty() {
            return;
        }
        self.fill(i / TILE);
        if let Some(run) = self.runs.last_mut() {
            run.has |= 1 << (i % TILE);
        }
        self.values.extend_from_slice(list);
        self.ends.push(self.values.len() as u32);
    }

    /// All lists of so many pixels.
    pub fn ended(mut self, pixels: usize) -> Self {
        self.fill(pixels / TILE);
        self
    }

    /// Adds runs up to number `run`.
    fn fill(&mut self, run: usize) {
        self.runs.resize(self.runs.len().max(run + 1), Run { before: self.ends.len() as u32, has: 0 });
    }

    /// The numbers of pixel `i`.
    pub fn of(&self, i: usize) -> &[f64] {
        let Run { before, has } = self.runs[i / TILE];
        if has >> (i % TILE) & 1 == 0 {
            return &[];
        }
        let list = before as usize + (has & ((1 << (i % TILE)) - 1)).count_ones() as usize;
        let begin = if list == 0 { 0 } else { self.ends[list - 1] as usize };
        &self.values[begin..self.ends[list] as usize]
    }

    /// Whether any pixel from `from` to before `to` has numbers.
    pub fn any(&self, from: usize, to: usize) -> bool {
        let before = |i: usize| {
            let Run { before, has } = self.runs[i / TILE];
            before + (has & ((1 << (i % TILE)) - 1)).count_ones()
        };
        before(from) != before(to)
    }

    /// How many bytes it takes.
    pub fn bytes(&self) -> u64 {
        (size_of_val(&self.runs[..]) + size_of_val(&self.ends[..]) + size_of_val(&self.values[..])) as u64
    }

    /// One after another; each but the last is of a multiple of [`TILE`] pixels.
    pub fn concat(parts: Vec<Ragged>) -> Self {
        let mut all = Ragged::default();
        for part in parts {
            let (lists, values) = (all.ends.len() as u32, all.values.len() as u32);
            // The last entry tells only how many lists there are, as does the first of what follows.
            all.runs.pop();
            all.runs.extend(part.runs.iter().map(|run| Run { before: lists + run.before, ..*run }));
            all.ends.extend(part.ends.iter().map(|end| values + end));
            all.values.extend_from_slice(&part.values);
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pixel_has_its_list() {
        for pixels in [0, 1, 16, 31, 32, 77] {
            let lists: Vec<Vec<f64>> = (0..pixels)
                .map(|i| (0..[0, 0, 1, 0, 3, 2, 0][i * i % 7]).map(|k| (i * 9 + k) as f64).collect())
                .collect();
            let of = |from: usize, to: usize| Ragged::new(lists[from..to].iter().map(Vec::as_slice));
            let whole = of(0, pixels);
            lists.iter().enumerate().for_each(|(i, list)| assert_eq!(whole.of(i), list, "{i} of {pixels}"));
            for (from, to) in (0..=pixels).flat_map(|to| (0..=to).map(move |from| (from, to))) {
                assert_eq!(whole.any(from, to), lists[from..to].iter().any(|list| !list.is_empty()), "{from} {to}");
            }
            let ends = (0..pixels).step_by(2 * TILE).map(|from| (from, pixels.min(from + 2 * TILE)));
            let parts: Vec<Ragged> = ends.map(|(from, to)| of(from, to)).collect();
            assert!(pixels == 0 || Ragged::concat(parts) == whole, "{pixels}");
        }
    }
}
