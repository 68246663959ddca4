//! Change from shared steps to own steps.

use super::ending::{Chance, variation};
use super::frames::{CrowdPlace, POSE_NUMBERS};
use super::own::OwnWalk;
use super::rest::Rest;
use super::shared::Shared;
use super::styled_body::StyledBody;
use crate::config::GeneratorConfig;
use crate::detail::Detail;
use crate::plan::{MAX_COMPONENTS, Planner};
use crate::standing::{Life, Moment};
use footfall_core::GroundTransform;
use footfall_core::rotation::from_heading;

impl OwnWalk {
    /// Continues alone from the end of a shared step at this place, as the walker of this seed and with its progress of chance.
    pub(super) fn go_on_from(
        &mut self,
        (styled, config): (&StyledBody, &GeneratorConfig),
        (shared, pose): (&Shared, &[i16; POSE_NUMBERS]),
        start_from_end: &GroundTransform,
        (chance, rest_secs): (Chance, f32),
    ) {
        let fresh = Planner::new(
            &styled.0.measured.blend.model,
            config.seed,
            variation(config),
        );
        self.config = *config;
        self.styled = styled.clone();
        self.walker = *fresh.walker();
        self.chance = chance.max(Chance::of(&fresh));
        (*self.ending).clone_from(&shared.ending);
        self.shape = shared.shape;
        self.position = self.shape.timing.frames as f32;
        let place = CrowdPlace {
            place: shared.end,
            contact: [true; 2],
        };
        self.frames.hold(place, pose);
        self.landing = None;
        self.footstep = None;
        self.even = false;
        // The walker is at the end of the shared step in the plan of that step.
        let heading = shared.end.heading - start_from_end.heading;
        self.plan_from_start = GroundTransform {
            position: shared.end.position - from_heading(heading) * start_from_end.position,
            heading,
        };
        if let Some((still, life)) = &shared.still {
            match &mut self.rest {
                Some(rest) => rest.begin(still),
                none => *none = Some(Box::new(Rest::new(still))),
            }
            self.life = Some(life.clone());
            if let Some(life) = &mut self.life {
                life.moment = life.moment.after(rest_secs, true);
            }
        } else if let Some(life) = &mut self.life {
            life.become_walker(config);
            life.moment = Moment::default();
        } else {
            self.life = Life::new(styled.0.space.standing(), &styled.0.skeleton, config);
        }
    }

    /// Makes a walk at the end of a shared step.
    pub(super) fn from_shared(
        styled: &StyledBody,
        config: &GeneratorConfig,
        shared: &Shared,
    ) -> Self {
        let step = (shared.ending.clone(), shared.shape);
        Self {
            detail: Detail::Quarter,
            ..Self::before(styled, config, [0.0; MAX_COMPONENTS], step)
        }
    }
}
