//! Roster of a crowd: lasting names of walkers, and reused places in arrays.

use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Bits of a name that hold the place; the rest count the walkers that had it before.
const PLACE_BITS: u32 = 17;
const TURNS: u16 = 1 << (31 - PLACE_BITS);

/// Number of places that names can hold.
const MOST_PLACES: usize = 1 << PLACE_BITS;

/// A name for each walker: its place in all arrays, and the count of earlier walkers there.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct Roster {
    /// Per place, the number of walkers that have left it.
    turns: Vec<u16>,
    taken: Vec<bool>,
    /// Occupied places in the order of their walkers' arrival.
    order: Vec<u32>,
    /// Free places, the longest free first.
    free: VecDeque<u32>,
}

impl Roster {
    /// Places of all walkers, in the order of arrival.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Reserves memory for further walkers.
    pub(super) fn reserve(&mut self, more: usize) {
        self.order.reserve(more);
        self.turns.reserve(more);
        self.taken.reserve(more);
    }

    /// Assigns a place; it may lie one beyond the last.
    pub(super) fn enter(&mut self) -> usize {
        let place = self.free.pop_front().unwrap_or_else(|| {
            self.turns.push(0);
            self.taken.push(false);
            (self.turns.len() - 1) as u32
        });
        self.taken[place as usize] = true;
        self.order.push(place);
        place as usize
    }

    /// Assigns the place of a name, which must be free. It may lie beyond the last.
    pub(super) fn enter_as(&mut self, name: i32) {
        let Some((place, turn)) = parts(name) else {
            return;
        };
        while self.turns.len() <= place {
            self.free.push_back(self.turns.len() as u32);
            self.turns.push(0);
            self.taken.push(false);
        }
        // The latest walker mostly has the place that became free last.
        let free = self.free.iter().rposition(|free| *free as usize == place);
        free.and_then(|at| self.free.remove(at));
        self.turns[place] = turn;
        self.taken[place] = true;
        self.order.push(place as u32);
    }

    /// Frees occupied places.
    pub(super) fn leave(&mut self, places: &[usize]) {
        for place in places {
            self.taken[*place] = false;
            self.turns[*place] = (self.turns[*place] + 1) % TURNS;
            self.free.push_back(*place as u32);
        }
        let taken = &self.taken;
        self.order.retain(|place| taken[*place as usize]);
    }

    /// The roster, to be saved.
    pub(super) fn saved(&self) -> SavedRoster {
        SavedRoster {
            turns: self.turns.clone(),
            order: self.order.clone(),
            free: self.free.iter().copied().collect(),
        }
    }

    /// A saved roster; `None` if it is invalid.
    pub(super) fn restored(saved: &SavedRoster) -> Option<Self> {
        let places = saved.turns.len();
        let mut seen = vec![false; places];
        let all = saved.order.len() + saved.free.len();
        let turns = saved.turns.iter().all(|turn| *turn < TURNS);
        if places > MOST_PLACES || all != places || !turns {
            return None;
        }
        let mut taken = vec![false; places];
        for (index, place) in saved.order.iter().chain(&saved.free).enumerate() {
            let place = *place as usize;
            if place >= places || core::mem::replace(&mut seen[place], true) {
                return None;
            }
            taken[place] = index < saved.order.len();
        }
        Some(Self {
            turns: saved.turns.clone(),
            taken,
            order: saved.order.clone(),
            free: saved.free.iter().copied().collect(),
        })
    }

    /// Number of places, including free ones.
    pub(super) fn places(&self) -> usize {
        self.turns.len()
    }

    /// The name of the walker at a place.
    pub fn name(&self, place: usize) -> i32 {
        let turn = i32::from(self.turns.get(place).copied().unwrap_or(0));
        turn << PLACE_BITS | i32::try_from(place).unwrap_or(i32::MAX)
    }

    /// The place of the walker of this name, while it is in the crowd.
    pub fn place(&self, name: i32) -> Option<usize> {
        let (place, turn) = parts(name)?;
        let there = self.taken.get(place) == Some(&true) && self.turns[place] == turn;
        there.then_some(place)
    }
}

/// A roster in its saved form.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct SavedRoster {
    turns: Vec<u16>,
    order: Vec<u32>,
    free: Vec<u32>,
}

/// Place and turn of a name.
fn parts(name: i32) -> Option<(usize, u16)> {
    let name = u32::try_from(name).ok()?;
    let place = name as usize % MOST_PLACES;
    Some((place, (name >> PLACE_BITS) as u16))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_last_while_others_come_and_go() {
        let mut roster = Roster::default();
        let first: Vec<i32> = (0..5)
            .map(|_| {
                let place = roster.enter();
                roster.name(place)
            })
            .collect();
        assert_eq!(first, [0, 1, 2, 3, 4]);
        roster.leave(&[1, 3]);
        assert_eq!(roster.order(), [0, 2, 4]);
        assert_eq!(roster.place(1), None);
        assert_eq!(roster.place(4), Some(4));
        let place = roster.enter();
        assert_eq!(place, 1, "places are used again");
        let again = roster.name(place);
        assert_ne!(again, 1, "names are not");
        assert_eq!(roster.place(again), Some(1));
        assert_eq!(roster.place(1), None);
        assert_eq!(roster.order(), [0, 2, 4, 1]);
        assert_eq!(roster.place(-1), None);
        assert_eq!(roster.place(i32::MAX), None);
    }

    #[test]
    fn who_has_a_name_already_gets_its_place() {
        let mut roster = Roster::default();
        let names = [3 << PLACE_BITS | 2, 0, 1 << PLACE_BITS | 4];
        for name in names {
            roster.enter_as(name);
            assert_eq!(roster.place(name), Some(parts(name).unwrap().0));
        }
        assert_eq!(roster.order(), [2, 0, 4]);
        assert_eq!(roster.place(2), None, "another turn");
        assert_eq!([roster.enter(), roster.enter(), roster.enter()], [1, 3, 5]);
        assert_eq!(Roster::restored(&roster.saved()), Some(roster));
    }

    #[test]
    fn a_place_can_be_left_more_often_than_there_are_turns() {
        let mut roster = Roster::default();
        for _ in 0..2 * u32::from(TURNS) + 3 {
            let place = roster.enter();
            let name = roster.name(place);
            assert!(name >= 0);
            assert_eq!(roster.place(name), Some(place));
            roster.leave(&[place]);
            assert_eq!(roster.place(name), None);
        }
    }

    #[test]
    fn a_saved_roster_goes_on_with_the_same_names() {
        let mut roster = Roster::default();
        for _ in 0..4 {
            roster.enter();
        }
        roster.leave(&[0, 2]);
        roster.enter();
        let saved = roster.saved();
        let mut other = Roster::restored(&saved).unwrap();
        assert_eq!(other, roster);
        assert_eq!(other.enter(), roster.enter());
        assert_eq!(other, roster);
        for damaged in [
            SavedRoster {
                order: vec![7, 1, 3],
                ..saved.clone()
            },
            SavedRoster {
                order: vec![1, 1, 3],
                ..saved.clone()
            },
            SavedRoster {
                free: vec![],
                ..saved.clone()
            },
            SavedRoster {
                turns: vec![TURNS; 4],
                ..saved
            },
        ] {
            assert_eq!(Roster::restored(&damaged), None);
        }
    }
}
