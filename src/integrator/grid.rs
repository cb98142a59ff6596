//! Where a communication step stands. Integration steps end on halvings of it, or are free to be longer than it; either
//! way their lengths, and with them their coefficients, come again.

/// A communication step in grid.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// Start, s.
    pub start: f64,
    /// Length, s.
    pub size: f64,
    /// Part done, 0 to 1.
    pub done: f64,
    /// Whether the one step taken may be longer.
    pub free: bool,
}

/// The next integration step.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Length, s.
    pub length: f64,
    /// Whether the length is a halving of the communication step.
    pub recurring: bool,
    /// Part of the communication step done at its end.
    pub done: f64,
    /// The instant at its end, s.
    pub time: f64,
}

impl Grid {
    /// At the start of the communication step from `start` by `size` (s).
    pub fn over(start: f64, size: f64) -> Self {
        Self {
            start,
            size,
            done: 0.0,
            free: false,
        }
    }

    /// At the start of one free step, at the instant `start` (s), likely of about `size` (s).
    pub fn free(start: f64, size: f64) -> Self {
        Self {
            free: true,
            ..Self::over(start, size)
        }
    }

    /// The end of the communication step, s.
    pub fn end(&self) -> f64 {
        self.time(1.0)
    }

    /// What is left to do, s.
    pub fn left(&self) -> f64 {
        if self.free {
            f64::INFINITY
        } else {
            (1.0 - self.done) * self.size
        }
    }

    /// The next step from the instant `time` (s), not longer than about `wanted` (s), which ends at `corner` (s) at the
    /// latest.
    pub fn target(&self, wanted: f64, time: f64, corner: Option<f64>) -> Target {
        if self.free {
            let length = round_down(wanted);
            let corner = corner.filter(|corner| *corner < time + length);
            return corner.map_or(
                Target {
                    length,
                    recurring: true,
                    done: 1.0,
                    time: time + length,
                },
                |corner| self.cut(corner - time, corner),
            );
        }
        let done = if self.done == 0.0 && wanted >= self.size {
            1.0
        } else {
            self.grid_point(wanted)
        };
        if let Some(corner) = corner.filter(|corner| *corner < self.start + done * self.size) {
            return self.cut(corner - time, corner);
        }
        let part = done - self.done;
        // Halvings of one are exact in binary: nothing but the exponent is set.
        let recurring = part.to_bits().trailing_zeros() >= f64::MANTISSA_DIGITS - 1;
        Target {
            length: part * self.size,
            recurring,
            done,
            time: self.time(done),
        }
    }

    /// The step of `length` (s) that ends at `time` (s), off the grid.
    pub fn cut(&self, length: f64, time: f64) -> Target {
        let done = if self.free {
            1.0
        } else {
            (self.done + length / self.size).min(1.0)
        };
        let time = if done == 1.0 && !self.free {
            self.time(done)
        } else {
            time
        };
        Target {
            length,
            recurring: false,
            done,
            time,
        }
    }

    /// The next point of the grid whose cells are at most `wanted` seconds long, unless it is too near to be worth a
    /// step.
    fn grid_point(&self, wanted: f64) -> f64 {
        let level = (self.size / wanted).log2().ceil().clamp(0.0, 52.0);
        let cell = (-level).exp2();
        // From a point of the grid the step is a halving: as long as wanted, or shorter where only finer cells begin
        // here.
        let aligned = (0..6)
            .map(|finer| cell * 0.5_f64.powi(finer))
            .find(|cell| (self.done / cell).fract() == 0.0);
        if let Some(cell) = aligned {
            return (self.done + cell).min(1.0);
        }
        // After an event the grid has to be found again.
        let point = ((self.done / cell).floor() + 1.0) * cell;
        let point = if point - self.done < 0.3 * cell {
            point + 0.5 * cell
        } else {
            point
        };
        point.min(1.0)
    }

    fn time(&self, done: f64) -> f64 {
        self.start + done * self.size
    }
}

/// The next lower power of two or one and a half times a power of two: of these few lengths the coefficients are kept.
fn round_down(length: f64) -> f64 {
    f64::from_bits(length.to_bits() & (u64::MAX << (f64::MANTISSA_DIGITS - 2)))
}
