//! Confusion of styles: the paper's Table 2 and equation 16.

/// Counts of judgements by actual class and by the class that was named.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Confusion {
    /// Names of the classes.
    pub labels: Vec<String>,
    /// Row: the actual class; column: the class named.
    pub counts: Vec<Vec<usize>>,
}

impl Confusion {
    /// No judgement yet.
    pub fn new(labels: Vec<String>) -> Self {
        let counts = vec![vec![0; labels.len()]; labels.len()];
        Self { labels, counts }
    }

    /// Adds a judgement. Classes that there are not are left out.
    pub fn add(&mut self, actual: usize, named: usize) {
        let row = self.counts.get_mut(actual);
        if let Some(count) = row.and_then(|row| row.get_mut(named)) {
            *count += 1;
        }
    }

    /// Number of judgements of a class.
    pub fn judged(&self, actual: usize) -> usize {
        self.counts[actual].iter().sum()
    }

    /// Number of judgements.
    pub fn total(&self) -> usize {
        self.counts.iter().flatten().sum()
    }

    /// Share of right judgements; `None` without a judgement.
    pub fn rate(&self) -> Option<f64> {
        let right = (0..self.labels.len()).map(|class| self.counts[class][class]);
        let total = self.total();
        (total > 0).then(|| right.sum::<usize>() as f64 / total as f64)
    }

    /// Share of right judgements of one class; `None` without a judgement of it.
    pub fn class_rate(&self, actual: usize) -> Option<f64> {
        let judged = self.judged(actual);
        (judged > 0).then(|| self.counts[actual][actual] as f64 / judged as f64)
    }

    /// Recognition efficiency: the rate over what blind guessing among all classes gives (Tilmanne et al. 2012, equation
    /// 16).
    pub fn efficiency(&self) -> Option<f64> {
        self.rate().map(|rate| rate * self.labels.len() as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn paper_like() -> Confusion {
        let mut confusion = Confusion::new(["a", "b", "c", "d"].map(str::to_owned).to_vec());
        for (actual, named) in [
            (0, 0),
            (0, 0),
            (0, 0),
            (0, 2),
            (1, 1),
            (1, 3),
            (2, 2),
            (2, 0),
        ] {
            confusion.add(actual, named);
        }
        confusion
    }

    #[test]
    fn rates_and_efficiency_are_those_counted_by_hand() {
        let confusion = paper_like();
        assert_eq!(confusion.total(), 8);
        assert_eq!(confusion.counts[0], [3, 0, 1, 0]);
        assert!((confusion.rate().unwrap() - 5.0 / 8.0).abs() < 1e-12);
        assert!((confusion.class_rate(0).unwrap() - 0.75).abs() < 1e-12);
        assert_eq!(confusion.class_rate(3), None);
        assert!((confusion.efficiency().unwrap() - 2.5).abs() < 1e-12);
        assert_eq!(Confusion::new(Vec::new()).rate(), None);
    }

    proptest! {
        #[test]
        fn every_judgement_counts_once(judgements in proptest::collection::vec((0_usize..5, 0_usize..5), 1..80)) {
            let mut confusion = Confusion::new((0..5).map(|class| class.to_string()).collect());
            for (actual, named) in &judgements {
                confusion.add(*actual, *named);
            }
            prop_assert_eq!(confusion.total(), judgements.len());
            let rate = confusion.rate().unwrap();
            prop_assert!((0.0..=1.0).contains(&rate));
            let weighted: f64 = (0..5)
                .filter_map(|class| Some(confusion.class_rate(class)? * confusion.judged(class) as f64))
                .sum();
            prop_assert!((weighted / judgements.len() as f64 - rate).abs() < 1e-12);
        }
    }
}
