//! Parts of a state that depend on the source of steps, and their restoration.

use super::{Led, Quick, Running, Source, Stance, State, StateError, detail_of};
use crate::config::GeneratorConfig;
use crate::gait::{Manner, Pace, StepRequest};
use crate::ground::PlanterState;
use crate::plan::{MAX_COMPONENTS, StepDraw, TIE_LEN, WINDOW};
use crate::source::{
    MeasuredBlend, Origin, StepWindow, StyledSteps, SwitchingOrigin, SwitchingSteps, planner_of,
};
use footfall_core::{Side, Skeleton, StepPosition};
use footfall_model::GaitModel;
use std::sync::Arc;

impl Source {
    pub(super) fn of_styled(steps: &StyledSteps) -> Self {
        let origin = steps.window.origin();
        let components = components_of(steps.space.model());
        let draws = steps.window.draws();
        let used = draws.iter().flat_map(|draw| {
            let used = draw.weights.len().min(components);
            draw.weights[..used].iter().copied()
        });
        let manners = [origin.manner_before, origin.request.manner];
        let blends = steps.window.blends();
        Self::Styled {
            weights: [blends[0], blends[1], &steps.measured.blend]
                .map(|blend| blend.weights.clone()),
            left_first: draws[0].side == Side::Left,
            draws: used.collect(),
            paces: manners
                .map(|manner| manner.pace)
                .map(|pace| [pace.covariate_mps, pace.tempo, pace.stride]),
            positions: manners.map(|manner| manner.position.index() as u8),
            details: manners.map(|manner| manner.detail as u8),
            tie: if origin.planter.is_some() {
                origin.tie.to_vec()
            } else {
                Vec::new()
            },
        }
    }

    pub(super) fn of_switching(steps: &SwitchingSteps) -> Self {
        let origin = &steps.origin;
        Self::Switching {
            left: origin.leading == Side::Left,
            pace: [origin.tempo, origin.stride],
            detail: origin.detail as u8,
            expected: origin.expected.clone(),
        }
    }
}

impl State {
    /// Restores styled steps; on failure they stay unchanged.
    pub(super) fn take_up(
        &self,
        steps: &mut StyledSteps,
        (running, quick, leap_m, stance, led): (&Running, &Quick, Option<f32>, &Stance, &Led),
        skeleton: &Skeleton,
        config: &GeneratorConfig,
    ) -> Result<(), StateError> {
        let space = Arc::clone(&steps.space);
        if self.model != space.fingerprint() {
            return Err(StateError::OtherModel);
        }
        let Source::Styled {
            weights,
            left_first,
            draws,
            paces,
            positions,
            details,
            tie,
        } = &self.steps
        else {
            return Err(StateError::OtherModel);
        };
        let found = space.styles().len();
        if let Some(weights) = weights.iter().find(|w| w.len() != found) {
            let expected = weights.len();
            return Err(StateError::OtherStyles { expected, found });
        }
        let components = components_of(space.model()).min(MAX_COMPONENTS);
        let ties = self.feet.is_none() || tie.len() == TIE_LEN;
        if draws.len() != WINDOW * components || !ties {
            return Err(StateError::Damaged);
        }
        let mut side = if *left_first { Side::Right } else { Side::Left };
        let draws = core::array::from_fn(|step| {
            side = side.other();
            let mut weights = [0.0; MAX_COMPONENTS];
            weights[..components].copy_from_slice(&draws[step * components..][..components]);
            StepDraw { side, weights }
        });
        let manner = |step: usize| {
            let [covariate_mps, tempo, stride] = paces[step];
            let position = StepPosition::ALL.get(usize::from(positions[step]));
            Manner {
                pace: Pace {
                    covariate_mps,
                    tempo,
                    stride,
                },
                position: position.copied().unwrap_or_default(),
                detail: detail_of(details[step]),
            }
        };
        let mut origin = Origin {
            request: StepRequest {
                manner: manner(1),
                amplitude: self.amplitude(),
                turn_rate: self.turn_rate,
                velocity_mps: quick.velocities_mps[1].into(),
                facing: self.facing[1],
                leap_m,
            },
            manner_before: manner(0),
            facing_before: self.facing[0],
            velocity_before_mps: quick.velocities_mps[0].into(),
            planter: self.feet.as_ref().map(|feet| PlanterState {
                airborne: running.airborne(),
                ..feet.planter(stance)
            }),
            tie: [0.0; TIE_LEN],
            remainder: quick.remainder(),
            displacement: led.displacement(),
        };
        if tie.len() == TIE_LEN {
            origin.tie.copy_from_slice(tie);
        }
        let mut planner = planner_of(&space, config);
        let [before, now, next] = weights.each_ref().map(|w| space.blend(w));
        let [gait_before, gait] = running.gaits();
        planner.resume(self.chance_position, &draws);
        planner.count_strides(led.strides);
        // A walker that goes back a little, as in predictive netcode, is measured already.
        let known =
            planner.is_same_walker(&steps.planner) && Arc::ptr_eq(&next, &steps.measured.blend);
        let window = &steps.window;
        let unchanged = (
            window.origin().clone(),
            window.draws().clone(),
            window.blends().map(Arc::clone),
        );
        space.with_buffers(|buffers| {
            let measured = if known {
                None
            } else {
                Some(MeasuredBlend::measure(&planner, skeleton, next, buffers)?)
            };
            let blends = [before.of_gait(gait_before), now.of_gait(gait)];
            if origin.planter.is_none() {
                // The very first step may fail, so it is tried on another window.
                steps.window = {
                    let mut window = StepWindow::new(skeleton, &now);
                    window.restore(&mut planner, blends, draws, origin, buffers)?;
                    window
                };
            } else {
                steps
                    .window
                    .restore(&mut planner, blends, draws, origin, buffers)?;
            }
            // Numbers within their limits may still add up to a step that nobody takes.
            if !steps.window.is_sound() {
                let (origin, draws, blends) = unchanged;
                let blends = blends.each_ref();
                steps
                    .window
                    .restore(&mut steps.planner, blends, draws, origin, buffers)?;
                return Err(StateError::Nowhere);
            }
            if let Some(measured) = measured {
                steps.measured = measured;
            }
            Ok::<_, StateError>(())
        })?;
        steps.planner = planner;
        steps.velocity_mps = self.velocity_mps.into();
        steps.applied = quick.applied();
        Ok(())
    }

    /// Restores switching steps.
    pub(super) fn resume(
        &self,
        steps: &mut SwitchingSteps,
        stance: &Stance,
        config: &GeneratorConfig,
    ) -> Result<(), StateError> {
        let Source::Switching {
            left,
            pace: [tempo, stride],
            detail,
            expected,
        } = &self.steps
        else {
            return Err(StateError::OtherModel);
        };
        if self.model != steps.fingerprint {
            return Err(StateError::OtherModel);
        }
        if ![0, 2 * steps.model.components.len()].contains(&expected.len()) {
            return Err(StateError::Damaged);
        }
        let origin = SwitchingOrigin {
            leading: if *left { Side::Left } else { Side::Right },
            tempo: *tempo,
            stride: *stride,
            detail: detail_of(*detail),
            amplitude: self.amplitude(),
            turn_rate: self.turn_rate,
            facing: self.facing,
            chance_position: self.chance_position,
            expected: expected.clone(),
            planter: self.feet.as_ref().map(|feet| feet.planter(stance)),
        };
        steps.resume(config, origin, self.velocity_mps.into());
        Ok(())
    }
}

/// Returns the largest number of step components, walked or run.
fn components_of(model: &GaitModel) -> usize {
    let own = model.variation.step.len();
    let running = model.running.as_ref();
    running.map_or(own, |running| own.max(running.variation.step.len()))
}
