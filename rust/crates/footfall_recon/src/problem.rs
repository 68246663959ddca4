//! Problems with a sensor and its mounting, each with what to do next.

use footfall_core::Site;
use footfall_imu::StreamFault;

/// Problem with a sensor. Meanwhile the body stands or continues as is probable.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SensorProblem {
    /// No samples arrive.
    #[error(
        "no samples from the sensor; check that it is on, charged, in range, and sends to this machine"
    )]
    Silent,
    /// The samples themselves are at fault.
    #[error(transparent)]
    Stream(#[from] StreamFault),
    /// It is still, and oriented differently than on a standing person.
    #[error(
        "the sensor was put down, or its wearer sits or lies: the body stands; stand up, or put the sensor back on as before"
    )]
    Lies,
    /// It moves as a whole, without steps.
    #[error(
        "the sensor moves without steps, as in a lift or a vehicle: the body stands; wait until the ride ends"
    )]
    Rides,
    /// The model explains little of the measurements.
    #[error(
        "the model does not know this motion: the body stands; strap the sensor firmly to the {}, walk a few steps, and calibrate again", place(*site)
    )]
    Unexplained {
        /// The site that the model is for.
        site: Site,
    },
    /// It is worn on the other side of the body.
    #[error(
        "the sensor moves like one on the {}, the model is for the {}; move it to the other side, or load the model of that side", place(*worn), place(*site)
    )]
    OtherSide {
        /// The site that the model is for.
        site: Site,
        /// Site of the sensor.
        worn: Site,
    },
    /// It is turned from the assumed mounting.
    #[error(
        "the sensor is turned by {degrees:.0}° from its mounting: it has slipped, or belongs to another player; put it back, or calibrate again"
    )]
    Turned {
        /// Angle between both mountings.
        degrees: f32,
    },
    /// Two sensors of one body are swapped.
    #[error(
        "the sensors of {} and {} are swapped; exchange them, or pass them in the other order", place(*first), place(*second)
    )]
    Exchanged {
        /// The model's first site.
        first: Site,
        /// The second.
        second: Site,
    },
}

impl SensorProblem {
    /// The name for scripts and reports, for example `stuck_axis` or `lies`.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Silent => "silent",
            Self::Stream(fault) => fault.name(),
            Self::Lies => "lies",
            Self::Rides => "rides",
            Self::Unexplained { .. } => "unexplained",
            Self::OtherSide { .. } => "other_side",
            Self::Turned { .. } => "turned",
            Self::Exchanged { .. } => "exchanged",
        }
    }

    /// Returns true when both are the same problem, whatever their figures.
    pub fn is_alike(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Stream(own), Self::Stream(other)) => own.is_alike(other),
            _ => self.name() == other.name(),
        }
    }
}

/// A site in a sentence: `right foot`.
fn place(site: Site) -> String {
    site.name().replace('_', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_the_site_and_the_next_thing_to_do() {
        let other = SensorProblem::OtherSide {
            site: Site::RightFoot,
            worn: Site::LeftFoot,
        };
        let text = other.to_string();
        assert!(
            text.contains("one on the left foot") && text.contains("for the right foot"),
            "{text}"
        );
        assert!(text.contains("move it to the other side"), "{text}");
        let fault = SensorProblem::from(StreamFault::Slow { rate_hz: 12.0 });
        assert_eq!(fault.name(), "slow");
        assert!(fault.to_string().contains("12 samples"), "{fault}");
    }
}
