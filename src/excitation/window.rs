//! The interval of time in which a generator acts.

/// An interval of time, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// t0.
    pub start: f64,
    /// Infinite if there is no end.
    pub end: f64,
}

impl From<f64> for Window {
    /// From the instant (s) on, without an end.
    fn from(start: f64) -> Self {
        Self {
            start,
            end: f64::INFINITY,
        }
    }
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
        let next = if self.start > time { self.start } else { self.end };
        (next > time && next < f64::INFINITY).then_some(next)
    }
}
