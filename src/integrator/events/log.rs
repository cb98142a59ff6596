//! Openings and closings as the integrator meets them, for whoever wants to be told of each.

/// The contact opens or closes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// s.
    pub time: f64,
    /// Whether it closes.
    pub closes: bool,
}

/// How many are kept of a communication step.
const ROOM: usize = 1024;

/// The events of a communication step, and those the integrator has met ahead of its end. The first ones, where there is
/// no room for all.
#[derive(Clone, Debug)]
pub struct Events {
    list: Vec<Event>,
    /// How many there was no room for.
    pub left_out: u64,
}

impl Events {
    /// None.
    pub fn new() -> Self {
        Self {
            list: Vec::with_capacity(ROOM),
            left_out: 0,
        }
    }

    /// One more.
    pub(crate) fn record(&mut self, event: Event) {
        if self.list.len() < ROOM {
            self.list.push(event);
        } else {
            self.left_out += 1;
        }
    }

    /// Forgets those up to an instant (s): a communication step begins there.
    pub(crate) fn forget_until(&mut self, time: f64) {
        if self.list.is_empty() {
            return;
        }
        self.left_out = 0;
        self.list.retain(|event| event.time > time);
    }

    /// Forgets those after an instant (s): the motion is taken back.
    pub(crate) fn forget_after(&mut self, time: f64) {
        self.list.retain(|event| event.time <= time);
    }

    /// Those up to an instant, s.
    pub fn until(&self, time: f64) -> impl Iterator<Item = &Event> {
        self.list.iter().filter(move |event| event.time <= time)
    }
}

impl Default for Events {
    fn default() -> Self {
        Self::new()
    }
}
