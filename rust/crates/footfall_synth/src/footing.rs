//! The walk and the ground that it is put on: where feet will land, and steps that are to land elsewhere.

use crate::footstep::Footstep;
use crate::generator::GaitGenerator;
use crate::plan::StepShape;
use crate::stage::{Arrival, Stage};
use footfall_core::GroundTransform;
use footfall_core::rotation::from_heading;
use footfall_ik::placement::{Frame, Landing};
use glam::Vec3;

/// Until this share of a step it can still become another.
const STRETCHED_UNTIL: f32 = 0.25;
/// By how much a step is shortened and lengthened at most.
const SHORTEST: f32 = 0.25;
const LONGEST: f32 = 1.5;
/// By how much it is quicker at most: nobody trips up stairs.
const MOST_HASTE: f32 = 1.5;
/// Steps are no shorter than this and near enough to what was wanted within that, metres, which takes so many trials at most.
const SHORT_STEP_M: f32 = 0.05;
const SAME_LENGTH_M: f32 = 0.01;
const STRETCHES: usize = 3;

impl GaitGenerator {
    /// Next landing of each foot and the body's place then, for callers that put feet on real ground.
    pub fn landings(&self) -> [Option<Landing>; 2] {
        let arrival = &self.steps.source().stage().arrival;
        landings(self.next_footstep(), &self.plan_from_character(), arrival)
    }

    /// Leaves the current step as it is: something else that is asked for waits for the next one. For whoever has chosen a foothold for it.
    pub fn keep_step(&mut self) {
        self.steps.source_mut().keep();
    }

    /// Goes on on a way of this grade, rise by run, positive uphill: the trunk leans into it. For whoever knows the ground; until it is told otherwise.
    ///
    /// A grade that is not finite counts as level. Nothing happens with a switching model.
    pub fn set_grade(&mut self, grade: f32) {
        if let Some(moves) = &mut self.moves {
            moves.climb(grade);
        }
    }

    /// Has the step that has just begun land at this share of its way, within what people do; the walk goes on at the speed that this
    /// gives and comes back to the one that is asked for with the steps to follow. Once a step is under way it stays as it is.
    pub fn stretch_step(&mut self, share: f32) {
        let timing = self.shape().timing;
        let begun = self.position < STRETCHED_UNTIL * timing.frames as f32;
        if !begun || timing.rests || !share.is_finite() {
            return;
        }
        let length = step_length(self.shape(), self.steps.source().stage());
        let wanted = share.clamp(SHORTEST, LONGEST) * length;
        if wanted < SHORT_STEP_M {
            return;
        }
        // Who is to go on at a speed in shorter steps takes them quicker, and who brakes less so.
        let secs = timing.frames as f32 / self.frame_rate_hz;
        let quickest = (secs * self.asked_mps / wanted).min(length / wanted);
        let haste = quickest.clamp(1.0, MOST_HASTE);
        let mut trials = 0..STRETCHES;
        let mut next = |shape: &StepShape, stage: &Stage| {
            trials.next()?;
            let length = step_length(shape, stage);
            let far = (length - wanted).abs() >= SAME_LENGTH_M;
            far.then(|| wanted / length.max(SHORT_STEP_M))
        };
        self.steps.source_mut().stretch(haste, &mut next);
    }
}

/// Landing of the next footstep, and the body's place with it, seen from where the character is.
pub(crate) fn landings(
    next: Option<(Footstep, f32)>,
    from: &GroundTransform,
    arrival: &Arrival,
) -> [Option<Landing>; 2] {
    let mut landings = [None; 2];
    if let Some((footstep, secs)) = next {
        let back = from_heading(-from.heading);
        let seen = |place: Vec3| back * (place - from.position);
        landings[footstep.side.index()] = Some(Landing {
            flat: Frame {
                position: footstep.position,
                rotation: from_heading(footstep.heading),
            },
            secs,
            hips: seen(arrival.hips),
            ankles: arrival.ankles.map(seen),
        });
    }
    landings
}

/// Distance of a landing foot ahead of the standing one, metres.
fn step_length(shape: &StepShape, stage: &Stage) -> f32 {
    let way = stage.travel(shape).normalize_or_zero();
    let leading = shape.timing.leading;
    let [from, to] = [leading, leading.other()].map(|side| stage.plant(side));
    from.zip(to)
        .map_or(0.0, |(from, to)| (to.flat_ankle - from.flat_ankle).dot(way))
}
