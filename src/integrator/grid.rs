//! The grid of a communication step. Integration steps are dyadic fractions of it; off these, after an event, and where its size is
//! not expected again, they have a few rounded lengths, and the last one is cut. So step lengths recur, and their coefficients can
//! be cached.

/// Progress within a communication step.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// Start, s.
    pub start: f64,
    /// Length, s.
    pub size: f64,
    /// Fraction completed, 0 to 1.
    pub done: f64,
    /// A single step that may be longer than `size`.
    pub free: bool,
    /// Whether `size` is expected to recur, so that its fractions do.
    pub recurs: bool,
}

/// The next integration step.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Length, s.
    pub length: f64,
    /// Whether the length is expected to recur: its coefficients are cached.
    pub recurring: bool,
    /// Fraction of the communication step completed at its end, 0 to 1.
    pub done: f64,
    /// The instant at its end, s.
    pub time: f64,
}

impl Grid {
    /// A communication step from `start` over `size` (s).
    pub fn over(start: f64, size: f64) -> Self {
        Self { start, size, done: 0.0, free: false, recurs: true }
    }

    /// One free step from `start` (s), expected to be about `size` (s) long.
    pub fn free(start: f64, size: f64) -> Self {
        Self { free: true, recurs: false, ..Self::over(start, size) }
    }

    /// The end of the communication step, s.
    pub fn end(&self) -> f64 {
        self.time(1.0)
    }

    /// Remaining time, s.
    pub fn remaining(&self) -> f64 {
        if self.free { f64::INFINITY } else { (1.0 - self.done) * self.size }
    }

    /// Largest ratio of a length to the one before it, 1.
    pub fn spacing(&self) -> f64 {
        if self.recurs { 2.0 } else { 1.5 }
    }

    /// The next step from `time` (s), of at most about `requested` seconds, ending at the latest at `corner` (s), the
    /// next discontinuity of the excitation.
    pub fn target(&self, requested: f64, time: f64, corner: Option<f64>) -> Target {
        let Some(done) = self.recurs.then(|| self.grid_point(requested)).flatten() else {
            return self.rounded(requested, time, corner);
        };
        if let Some(corner) = corner.filter(|corner| *corner < self.start + done * self.size) {
            return self.cut(corner - time, corner);
        }
        Target { length: (done - self.done) * self.size, recurring: true, done, time: self.time(done) }
    }

    /// As [`Grid::target`], with a length of free steps, that may reach beyond the communication step.
    fn rounded(&self, requested: f64, time: f64, corner: Option<f64>) -> Target {
        let (end, remaining) = (self.end(), self.remaining());
        let shorter = round_down(requested);
        let (length, done) = if self.free {
            (shorter, 1.0)
        } else if time + shorter < end {
            (shorter, (self.done + shorter / self.size).min(1.0))
        } else {
            (round_up(remaining), 1.0)
        };
        if let Some(corner) = corner.filter(|corner| *corner < time + length) {
            let corner = if self.free { corner } else { corner.min(end) };
            return self.cut(corner - time, corner);
        }
        Target { length, recurring: true, done, time: time + length }
    }

    /// The step of `length` (s) that ends at `time` (s), off the grid.
    pub fn cut(&self, length: f64, time: f64) -> Target {
        let done = if self.free || time >= self.end() { 1.0 } else { (self.done + length / self.size).min(1.0) };
        let time = if done == 1.0 && !self.free { self.time(done) } else { time };
        Target { length, recurring: false, done, time }
    }

    /// The next point of the dyadic grid with cells of at most `requested` seconds, as fraction of the communication step; `None` off
    /// the grid, after an event.
    fn grid_point(&self, requested: f64) -> Option<f64> {
        if self.done == 0.0 && requested >= self.size {
            return Some(1.0);
        }
        let level = (self.size / requested).log2().ceil().clamp(0.0, 52.0);
        let cell = (-level).exp2();
        // One cell, or a finer one where no cell of this size begins here.
        let mut cells = (0..6).map(|finer| cell * 0.5_f64.powi(finer));
        let aligned = cells.find(|cell| (self.done / cell).fract() == 0.0)?;
        Some((self.done + aligned).min(1.0))
    }

    fn time(&self, done: f64) -> f64 {
        self.start + done * self.size
    }
}

/// Rounds down to `2^n` or `1.5 2^n`, so that the lengths of free steps recur.
pub(crate) fn round_down(length: f64) -> f64 {
    f64::from_bits(length.to_bits() & (u64::MAX << (f64::MANTISSA_DIGITS - 2)))
}

/// Rounds up to `2^n` or `1.5 2^n`.
fn round_up(length: f64) -> f64 {
    let below = round_down(length);
    let half = 1_u64 << (f64::MANTISSA_DIGITS - 2);
    if below == length { length } else { f64::from_bits(below.to_bits() + half) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn after_an_event_anywhere_steps_have_lengths_that_recur() {
        for k in 1..1000 {
            let grid = Grid { done: f64::from(k) / 1000.0, ..Grid::over(0.5, 1e-5) };
            let target = grid.target(1e-7 * f64::from(k % 90 + 1), grid.time(grid.done), None);
            let part = target.done - grid.done;
            let fraction = part.log2().fract() == 0.0 && target.length == part * grid.size;
            assert!(target.recurring && (fraction || target.length == round_down(target.length)), "{k}: {target:?}");
        }
    }

    /// It would be cut to nothing at its start, time and again.
    #[test]
    fn no_step_begins_at_the_end() {
        let length = 1.5 * (-14.0_f64).exp2();
        for start in [0.0, 9.243_236_078_726_682e-4, 0.1, 1.0] {
            for spacings in -8..8 {
                let size = f64::from_bits((4.0 * length).to_bits().saturating_add_signed(spacings));
                let mut grid = Grid { recurs: false, ..Grid::over(start, size) };
                let mut time = grid.start;
                while grid.done < 1.0 {
                    assert!(time < grid.end(), "{start} {spacings}: {grid:?}");
                    let target = grid.target(length, time, None);
                    (time, grid.done) = (target.time, target.done);
                }
                assert!(time >= grid.end(), "{start} {spacings}: {time}");
            }
        }
    }

    #[test]
    fn steps_of_a_length_that_does_not_recur_have_lengths_that_do() {
        let mut seen = Vec::new();
        for k in 0..1000 {
            // From 1 to 16 us.
            let size = 1e-6 * 16_f64.powf(f64::from(k) / 1000.0);
            let mut grid = Grid { recurs: false, ..Grid::over(0.5, size) };
            let mut time = grid.start;
            while grid.done < 1.0 {
                let target = grid.target(0.7e-6 * f64::from(k % 7 + 1), time, None);
                assert!(target.recurring && target.length == round_down(target.length));
                seen.push(target.length);
                // Only the last one reaches beyond the end.
                assert!(target.time <= grid.end() || target.done == 1.0);
                (time, grid.done) = (target.time, target.done);
            }
            assert!(time >= grid.end() - f64::EPSILON && time < grid.end() + 0.51 * size);
        }
        seen.sort_by(f64::total_cmp);
        seen.dedup();
        assert!(seen.len() < 120, "{seen:?}");
    }
}
