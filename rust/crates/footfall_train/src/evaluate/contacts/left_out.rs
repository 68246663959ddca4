//! Choice of limits without the person who is judged.

use super::Agreement;
use super::people::mean_and_worst_f1;
use std::collections::BTreeMap;

/// Limits, and the agreement of all people under them.
pub(super) type Trial<L, P> = (L, BTreeMap<String, P>);

/// The trial with the greatest mean F1 of all people but one, each of their agreements counting once; of equal ones the first.
pub(super) fn best_without<'a, L, P>(
    trials: &'a [Trial<L, P>],
    left_out: &str,
    agreements: impl Fn(&P) -> Vec<&Agreement>,
) -> Option<&'a Trial<L, P>> {
    let score = |people: &BTreeMap<String, P>| {
        let others = people.iter().filter(|(name, _)| *name != left_out);
        let agreements = others.flat_map(|(_, person)| agreements(person));
        mean_and_worst_f1(agreements).map_or(0.0, |[mean, _]| mean)
    };
    let scored = trials.iter().map(|trial| (score(&trial.1), trial));
    let best = scored.rev().max_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, trial)| trial)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten events, this many of which are found.
    fn agreement(matched: usize) -> Agreement {
        let known: Vec<f64> = (0..10).map(f64::from).collect();
        let found = known[..matched].to_vec();
        let mut agreement = Agreement::default();
        agreement.add(known, found, 1.0);
        agreement.summarise();
        agreement
    }

    fn chosen(trials: &[[usize; 3]], left_out: &str) -> usize {
        let trials: Vec<Trial<usize, Agreement>> = trials
            .iter()
            .enumerate()
            .map(|(n, matched)| {
                let people = ["a", "b", "c"].map(str::to_owned).into_iter();
                (n, people.zip(matched.map(agreement)).collect())
            })
            .collect();
        best_without(&trials, left_out, |person| vec![person]).map_or(usize::MAX, |trial| trial.0)
    }

    #[test]
    fn who_is_judged_has_no_say() {
        // The second trial is by far the best for a, and bad for the others.
        let trials = [[2, 8, 8], [10, 6, 6]];
        assert_eq!(chosen(&trials, "a"), 0);
        assert_eq!(chosen(&trials, "b"), 1);
        assert_eq!(chosen(&trials, "c"), 1);
    }

    #[test]
    fn of_equal_trials_the_first_is_chosen() {
        assert_eq!(chosen(&[[1, 8, 8], [9, 8, 8]], "a"), 0);
    }
}
