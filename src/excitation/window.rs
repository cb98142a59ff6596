//! The time during which a generator runs.

/// From one instant to another, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// t0.
    pub start: f64,
    /// Infinite where there is none.
    pub end: f64,
}

impl Window {
    /// Whether it is open at `time` (s) and just after it.
    pub fn is_open_after(&self, time: f64) -> bool {
        self.start <= time && time < self.end
    }

    /// Whether it is open at `time` (s) and just before it.
    pub fn is_open_before(&self, time: f64) -> bool {
        self.start < time && time <= self.end
    }

    /// The next instant after `time` (s) at which it opens or closes.
    pub fn next_end(&self, time: f64) -> Option<f64> {
        [self.start, self.end]
            .into_iter()
            .find(|end| *end > time && end.is_finite())
    }
}
