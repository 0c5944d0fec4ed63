//! What happens along a ray, in order.

/// What happens to a leaf at some t.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum What {
    /// The ray enters the leaf's box, or the leaf's answer ends: its state is open.
    Open,
    /// The next of the leaf's crossings.
    Cross,
}

/// An event.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Event {
    pub t: f64,
    /// Of the leaves met, which.
    pub met: u32,
    pub what: What,
}

/// Events by ascending t. New ones mostly come near the end, where they are put in place one by one; the order within one
/// t is that of their making, and changes nothing.
#[derive(Debug, Default)]
pub(super) struct Queue {
    events: Vec<Event>,
    head: usize,
}

impl Queue {
    pub fn clear(&mut self) {
        self.events.clear();
        self.head = 0;
    }

    /// The t of the next event; infinite where there is none.
    #[inline]
    pub fn next_t(&self) -> f64 {
        self.events.get(self.head).map_or(f64::INFINITY, |e| e.t)
    }

    /// Takes the next event if it is at this t.
    #[inline]
    pub fn pop_at(&mut self, t: f64) -> Option<Event> {
        let event = self.events.get(self.head).copied().filter(|e| e.t == t)?;
        self.head += 1;
        Some(event)
    }

    #[inline]
    pub fn push(&mut self, event: Event) {
        let mut at = self.events.len();
        while self.head < at && event.t < self.events[at - 1].t {
            at -= 1;
        }
        self.events.insert(at, event);
        // What has been taken is let go of now and then.
        if 64 < self.head && self.events.len() < 2 * self.head {
            self.events.drain(..self.head);
            self.head = 0;
        }
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
