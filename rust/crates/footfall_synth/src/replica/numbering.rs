//! Numbers of repeated steps.

/// Age of a received step, in steps, up to which it determines the number that is due: later, the walk itself knows better.
pub(super) const FRESH_STEPS: f64 = 3.0;

/// Returns the number of the next step of a walk that repeats another machine's.
///
/// It is `natural`, the one after the current step, unless a machine has stood still and the walks are whole strides apart: then it is the number that is due, or the one
/// beside it for the same foot. Otherwise no received step would be taken again. `last` is the number of the last received step, which was due `steps_since` steps ago.
#[must_use]
pub fn next_number(natural: u16, last: u16, steps_since: f64) -> u16 {
    if steps_since.abs() > FRESH_STEPS {
        return natural;
    }
    let due = last.wrapping_add_signed(steps_since.round() as i16);
    let pairs = natural.wrapping_sub(due).cast_signed() / 2;
    natural.wrapping_sub_signed(2 * pairs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_strides_are_made_good_and_feet_keep_their_turns() {
        assert_eq!(next_number(10, 9, 1.0), 10);
        assert_eq!(next_number(10, 8, 1.0), 10, "one ahead, on the other foot");
        assert_eq!(next_number(10, 6, 0.2), 6);
        assert_eq!(next_number(10, 5, 0.2), 6);
        assert_eq!(next_number(10, 12, 2.0), 14);
        assert_eq!(next_number(1, u16::MAX - 2, 0.0), u16::MAX - 2, "it wraps");
        assert_eq!(next_number(10, 2, 3.4), 10, "too old");
    }
}
