//! The body of the average walker.
//!
//! Recordings come over to a body of standard lengths with feet of their own. A walk belongs on such feet: on steeper ones the leg that pushes
//! off holds the hips lower than the leg that lands, and the body has to drop between them.

use footfall_core::{Side, Skeleton};
use footfall_motion::recording::Recording;
use glam::Vec3;
use std::collections::BTreeMap;

/// The canonical body with the mean foot of the people in these clips, each person counted once. `symmetric` gives both feet the mean slope.
pub(crate) fn average_body(clips: &[Recording], symmetric: bool) -> Skeleton {
    let mut people: BTreeMap<&str, (f32, [Vec3; 2])> = BTreeMap::new();
    for clip in clips {
        let (count, sums) = people.entry(clip.subject()).or_default();
        *count += 1.0;
        for side in Side::BOTH {
            sums[side.index()] += clip.clip().skeleton.offset(side.toes()).normalize_or_zero();
        }
    }
    let mut directions = [Vec3::ZERO; 2];
    for (count, sums) in people.values() {
        for (direction, sum) in directions.iter_mut().zip(sums) {
            *direction += sum / *count;
        }
    }
    if symmetric {
        directions = [directions[0] + directions[1]; 2];
    }
    Skeleton::with_feet(directions)
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::{Clip, Joint, Pose};
    use footfall_motion::retarget::Retargeted;

    fn clip(subject: &str, slopes_deg: [f32; 2]) -> Recording {
        let direction = |deg: f32| {
            let (sin, cos) = deg.to_radians().sin_cos();
            Vec3::new(0.0, -sin, cos)
        };
        let skeleton = Skeleton::with_feet(slopes_deg.map(direction));
        let clip = Clip {
            frame_rate_hz: 60.0,
            poses: vec![Pose::rest(&skeleton)],
            skeleton,
        };
        Recording::detected(Retargeted::canonical(clip)).of_subject(subject)
    }

    fn slope_deg(body: &Skeleton, side: Side) -> f32 {
        let offset = body.offset(side.toes());
        (-offset.y).atan2(offset.z).to_degrees()
    }

    #[test]
    fn a_person_of_many_clips_counts_once() {
        let clips = [
            clip("a", [10.0, 14.0]),
            clip("a", [10.0, 14.0]),
            clip("a", [10.0, 14.0]),
            clip("b", [20.0, 18.0]),
        ];
        let body = average_body(&clips, false);
        assert!((slope_deg(&body, Side::Left) - 15.0).abs() < 0.01);
        assert!((slope_deg(&body, Side::Right) - 16.0).abs() < 0.01);
        let even = average_body(&clips, true);
        assert!((slope_deg(&even, Side::Left) - 15.5).abs() < 0.01);
        assert!((slope_deg(&even, Side::Right) - 15.5).abs() < 0.01);
    }

    #[test]
    fn it_stands_on_flat_soles() {
        let body = average_body(&[clip("a", [12.0, 12.0])], true);
        for side in Side::BOTH {
            let ankle = body.hip_height() + body.offset(side.upper_leg()).y - body.leg_length(side);
            let foot = body.foot(side);
            let toes = ankle + body.offset(side.toes()).y;
            for height in [
                ankle + foot.heel.y,
                toes + foot.ball.y,
                toes + foot.toe_tip.y,
            ] {
                assert!(height.abs() < 1e-5, "{height}");
            }
        }
        assert_eq!(
            body.offset(Joint::Spine),
            Skeleton::standard().offset(Joint::Spine)
        );
    }

    #[test]
    fn without_people_it_is_the_standard_body() {
        let standard = Skeleton::standard().offset(Side::Left.toes());
        let body = average_body(&[], true).offset(Side::Left.toes());
        assert!(body.distance(standard) < 1e-6);
    }
}
