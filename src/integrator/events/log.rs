//! Log of openings and closings, for reference runs that need every event.

/// Openings and closings of a communication step that are kept for the log. Pinned: ÷ 512,
/// `every_event_is_reported_once`.
pub const EVENTS_KEPT: usize = 1024;

/// An opening or closing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Instant, s.
    pub time: f64,
    /// Whether it closes.
    pub closes: bool,
    /// Which link, in the order of the model.
    pub link: usize,
}

/// Events of a communication step, and those located ahead of its end; the first ones if there are too many.
#[derive(Clone, Debug)]
pub struct Events {
    list: Vec<Event>,
    /// Instant of the first that was not kept, s.
    left_out: Option<f64>,
}

impl Events {
    /// An empty log.
    pub(crate) fn new() -> Self {
        Self { list: Vec::with_capacity(EVENTS_KEPT), left_out: None }
    }

    /// Adds an event.
    pub(crate) fn record(&mut self, event: Event) {
        if self.list.len() < EVENTS_KEPT {
            self.list.push(event);
        } else {
            self.left_out = self.left_out.or(Some(event.time));
        }
    }

    /// Removes events up to an instant (s), at which a communication step begins.
    pub(crate) fn forget_until(&mut self, time: f64) {
        self.left_out = self.left_out.filter(|instant| *instant > time);
        self.list.retain(|event| event.time > time);
    }

    /// Removes events after an instant (s), from which integration restarts.
    pub(crate) fn forget_after(&mut self, time: f64) {
        self.left_out = self.left_out.filter(|instant| *instant <= time);
        self.list.retain(|event| event.time <= time);
    }

    /// Puts others in the place of events after an instant (s).
    pub(crate) fn replace_after(&mut self, time: f64, others: impl Iterator<Item = Event>) {
        self.forget_after(time);
        others.for_each(|event| self.record(event));
    }

    /// Events up to an instant (s), and when the first up to there was that is not among them, s.
    pub fn until(&self, time: f64) -> (impl Iterator<Item = &Event>, Option<f64>) {
        let told = self.list.iter().filter(move |event| event.time <= time);
        (told, self.left_out.filter(|instant| *instant <= time))
    }
}
