//! Detection of contacts for animations that do not know them: a foot that is low and slow stands.

/// Thresholds with hysteresis, as foot locks have them in Unreal and Untold Engine: below both a foot comes to stand, beyond either it no longer does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactThresholds {
    /// Speed over the ground below which a foot may come to stand, m/s.
    pub enter_mps: f32,
    /// Speed beyond which it no longer stands, m/s.
    pub exit_mps: f32,
    /// Height of the sole's lowest point below which a foot may come to stand, metres.
    pub enter_m: f32,
    /// Height beyond which it no longer stands, metres.
    pub exit_m: f32,
}

impl Default for ContactThresholds {
    fn default() -> Self {
        Self {
            enter_mps: 0.4,
            exit_mps: 1.0,
            enter_m: 0.03,
            exit_m: 0.06,
        }
    }
}

impl ContactThresholds {
    /// Returns true when a foot stands, given that it did so or not a moment ago.
    pub(crate) fn stands(&self, stood: bool, speed_mps: f32, height_m: f32) -> bool {
        if stood {
            speed_mps < self.exit_mps && height_m < self.exit_m
        } else {
            speed_mps < self.enter_mps && height_m < self.enter_m
        }
    }
}
