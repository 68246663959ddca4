//! Contacts that a person corrects: edits that keep stances apart, and undo.

use crate::motion::Motion;
use footfall_core::{FrameSpan, Side};
use footfall_motion::contact_file::ContactFile;

/// Edits that can be taken back.
const MOST_UNDO: usize = 200;

/// An end of a stance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    First,
    Last,
}

/// A stance: whose, and the how-manieth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct StanceId {
    pub(crate) side: Side,
    pub(crate) place: usize,
}

type Stances = [Vec<FrameSpan>; 2];

/// Stances of both feet, in order and apart from each other by at least a frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Labels {
    stances: Stances,
    frames: usize,
    undo: Vec<Stances>,
    redo: Vec<Stances>,
    /// True when a drag goes on, which is one edit.
    is_dragging: bool,
    saved: Stances,
}

impl Labels {
    pub(crate) fn of(motion: &Motion) -> Self {
        let contacts = &motion.recording.contacts;
        let stances = Side::BOTH.map(|side| contacts.foot(side).stances.clone());
        Self {
            saved: stances.clone(),
            stances,
            frames: contacts.frames,
            ..Self::default()
        }
    }

    pub(crate) fn stances(&self, side: Side) -> &[FrameSpan] {
        &self.stances[side.index()]
    }

    pub(crate) fn all(&self) -> &Stances {
        &self.stances
    }

    /// Returns true when there is something to save.
    pub(crate) fn is_dirty(&self) -> bool {
        self.stances != self.saved
    }

    /// Marks the present stances as saved.
    pub(crate) fn mark_saved(&mut self) {
        self.saved = self.stances.clone();
    }

    /// The stance that a frame lies in.
    pub(crate) fn stance_at(&self, side: Side, frame: usize) -> Option<StanceId> {
        let place = self
            .stances(side)
            .iter()
            .position(|span| span.contains(frame))?;
        Some(StanceId { side, place })
    }

    /// Moves an end of a stance, as far as its neighbours and its other end let it. A drag is one edit until
    /// [`end_drag`](Self::end_drag).
    pub(crate) fn drag(&mut self, id: StanceId, end: End, frame: usize) {
        if !self.is_dragging {
            self.remember();
            self.is_dragging = true;
        }
        let spans = &mut self.stances[id.side.index()];
        let Some(span) = spans.get(id.place).copied() else {
            return;
        };
        let before = id.place.checked_sub(1).map(|place| spans[place].last);
        let after = spans.get(id.place + 1).map(|span| span.first);
        let span = match end {
            End::First => {
                // A frame in the air lies between two stances.
                let least = before.map_or(0, |last| last + 2);
                FrameSpan {
                    first: frame.clamp(least.min(span.last), span.last),
                    ..span
                }
            }
            End::Last => {
                let most = after.map_or(self.frames.saturating_sub(1), |first| {
                    first.saturating_sub(2)
                });
                FrameSpan {
                    last: frame.clamp(span.first, most.max(span.first)),
                    ..span
                }
            }
        };
        spans[id.place] = span;
    }

    pub(crate) fn end_drag(&mut self) {
        self.is_dragging = false;
    }

    /// Adds a stance around a frame, as long as `frames` where there is room; `None` where the foot already stands.
    pub(crate) fn add(&mut self, side: Side, frame: usize, frames: usize) -> Option<StanceId> {
        if frame >= self.frames || self.stance_at(side, frame).is_some() {
            return None;
        }
        let spans = &self.stances[side.index()];
        let place = spans.partition_point(|span| span.last < frame);
        let least = place
            .checked_sub(1)
            .map_or(0, |before| spans[before].last + 2);
        let most = spans
            .get(place)
            .map_or(self.frames - 1, |after| after.first.saturating_sub(2));
        if frame < least || frame > most {
            return None;
        }
        self.remember();
        let span = FrameSpan {
            first: frame.saturating_sub(frames / 2).max(least),
            last: (frame + frames / 2).min(most),
        };
        self.stances[side.index()].insert(place, span);
        Some(StanceId { side, place })
    }

    pub(crate) fn remove(&mut self, id: StanceId) {
        if id.place < self.stances[id.side.index()].len() {
            self.remember();
            self.stances[id.side.index()].remove(id.place);
        }
    }

    /// Other stances instead, as one edit.
    pub(crate) fn replace(&mut self, stances: Stances) {
        if stances != self.stances {
            self.remember();
            self.stances = stances;
        }
    }

    pub(crate) fn can_undo(&self) -> bool {
        !self.undo.is_empty()
    }

    pub(crate) fn can_redo(&self) -> bool {
        !self.redo.is_empty()
    }

    pub(crate) fn undo(&mut self) {
        if let Some(before) = self.undo.pop() {
            self.redo
                .push(core::mem::replace(&mut self.stances, before));
        }
    }

    pub(crate) fn redo(&mut self) {
        if let Some(after) = self.redo.pop() {
            self.undo.push(core::mem::replace(&mut self.stances, after));
        }
    }

    fn remember(&mut self) {
        self.redo.clear();
        self.undo.push(self.stances.clone());
        if self.undo.len() > MOST_UNDO {
            self.undo.remove(0);
        }
    }

    /// As a file beside the recording holds it.
    pub(crate) fn to_file(&self, motion: &Motion) -> ContactFile {
        let contacts = motion.recording.detected.with_stances(self.stances.clone());
        ContactFile::new(&contacts, &motion.recording.walks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels() -> Labels {
        let span = |first, last| FrameSpan { first, last };
        let stances = [vec![span(10, 40), span(60, 90)], vec![span(30, 70)]];
        Labels {
            saved: stances.clone(),
            stances,
            frames: 120,
            ..Labels::default()
        }
    }

    const SECOND: StanceId = StanceId {
        side: Side::Left,
        place: 1,
    };

    #[test]
    fn an_end_stops_at_its_neighbour_and_at_its_other_end() {
        let mut labels = labels();
        labels.drag(SECOND, End::First, 5);
        assert_eq!(labels.stances(Side::Left)[1].first, 42);
        labels.drag(SECOND, End::First, 119);
        assert_eq!(labels.stances(Side::Left)[1].first, 90);
        labels.drag(SECOND, End::Last, 500);
        assert_eq!(labels.stances(Side::Left)[1].last, 119);
    }

    #[test]
    fn a_drag_is_one_edit_that_can_be_taken_back() {
        let mut labels = labels();
        for frame in 50..58 {
            labels.drag(SECOND, End::First, frame);
        }
        labels.end_drag();
        assert!(labels.is_dirty());
        labels.undo();
        assert!(!labels.is_dirty() && !labels.can_undo());
        labels.redo();
        assert_eq!(labels.stances(Side::Left)[1].first, 57);
    }

    #[test]
    fn a_new_stance_fits_between_its_neighbours() {
        let mut labels = labels();
        let id = labels.add(Side::Left, 50, 60).unwrap();
        assert_eq!(id.place, 1);
        let span = labels.stances(Side::Left)[1];
        assert_eq!((span.first, span.last), (42, 58));
        assert!(labels.add(Side::Left, 50, 60).is_none());
        assert!(labels.add(Side::Left, 41, 60).is_none(), "touches another");
        labels.remove(id);
        assert!(!labels.is_dirty());
    }
}
