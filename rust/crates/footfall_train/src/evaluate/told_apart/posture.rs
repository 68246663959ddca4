//! Knees and feet over strides.

use super::swings::StrideSwings;

/// Angles over all strides, radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Posture {
    /// Knee flexion below which a tenth of the time is spent.
    pub knee_tenth: f64,
    /// Median flexion of the leading knee at initial contact.
    pub knee_at_contact: f64,
    /// Median of the greatest flexion of the knee in a stride.
    pub knee_swing: f64,
    /// Mean pitch of the feet, positive with the toes down.
    pub foot_pitch: f64,
}

impl Posture {
    /// Measures of strides; zeros without any.
    pub fn of<'a>(strides: impl Iterator<Item = &'a StrideSwings>) -> Self {
        let (mut knees, mut at_contact, mut swing) = (Vec::new(), Vec::new(), Vec::new());
        let (mut pitch, mut count) = (0.0, 0.0);
        for stride in strides {
            let own = stride.side.index();
            knees.extend(stride.knees.iter().flatten().copied().map(f64::from));
            at_contact.push(f64::from(stride.knees[0][own]));
            let highest = stride.knees.iter().map(|knees| knees[own]);
            swing.push(f64::from(highest.fold(f32::MIN, f32::max)));
            pitch += stride
                .pitch
                .iter()
                .flatten()
                .map(|p| f64::from(*p))
                .sum::<f64>();
            count += 2.0 * stride.pitch.len() as f64;
        }
        Self {
            knee_tenth: quantile(knees, 0.1),
            knee_at_contact: quantile(at_contact, 0.5),
            knee_swing: quantile(swing, 0.5),
            foot_pitch: if count > 0.0 { pitch / count } else { 0.0 },
        }
    }
}

fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let index = (share * values.len() as f64) as usize;
    values.get(index).copied().unwrap_or_default()
}
