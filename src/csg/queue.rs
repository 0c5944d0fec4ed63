//! What happens along a ray, in order.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// What happens to a leaf at some t.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum What {
    /// The ray enters the leaf's box, or the leaf's answer ends: its state is open.
    Open,
    /// The next of the leaf's crossings.
    Cross,
}

/// An event.
#[derive(Clone, Copy, Debug)]
pub(super) struct Event {
    pub t: f64,
    /// Of the leaves met, which.
    pub met: u32,
    pub what: What,
}

impl PartialEq for Event {
    fn eq(&self, other: &Event) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Event {}

impl Ord for Event {
    /// The earlier is the greater: a heap gives its greatest first. The order within one t changes nothing.
    fn cmp(&self, other: &Event) -> Ordering {
        other.t.total_cmp(&self.t)
    }
}

impl PartialOrd for Event {
    fn partial_cmp(&self, other: &Event) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Events by ascending t.
#[derive(Debug, Default)]
pub(super) struct Queue {
    events: BinaryHeap<Event>,
}

impl Queue {
    pub fn clear(&mut self) {
        self.events.clear();
    }

    /// The t of the next event; infinite where there is none.
    #[inline]
    pub fn next_t(&self) -> f64 {
        self.events.peek().map_or(f64::INFINITY, |e| e.t)
    }

    /// Takes the next event if it is at this t.
    #[inline]
    pub fn pop_at(&mut self, t: f64) -> Option<Event> {
        if self.next_t() == t { self.events.pop() } else { None }
    }

    #[inline]
    pub fn push(&mut self, event: Event) {
        self.events.push(event);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::hash::Stream;

    #[test]
    fn events_come_out_in_order_whatever_the_order_they_went_in() {
        let mut stream = Stream::new(1);
        let mut queue = Queue::default();
        let mut at = f64::NEG_INFINITY;
        let mut left = 0;
        for met in 0..5000 {
            for _ in 0..2 {
                let t = if at.is_finite() { at + stream.unit() } else { stream.unit() };
                queue.push(Event { t, met, what: What::Open });
                left += 1;
            }
            let t = queue.next_t();
            assert!(at <= t);
            at = t;
            while queue.pop_at(t).is_some() {
                left -= 1;
            }
        }
        while queue.next_t() < f64::INFINITY {
            let t = queue.next_t();
            assert!(at <= t && queue.pop_at(t).is_some());
            at = t;
            left -= 1;
        }
        assert_eq!(left, 0);
    }
}
