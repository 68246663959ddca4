//! The swinging foot: from where it stood to where it lands, along the generated path.

use super::frame::PlantedFrame;
use super::generated::{GeneratedFrame, free_foot};
use super::planter::Planter;
use super::reach::yielding;
use crate::plan::StepTiming;
use core::f32::consts::PI;
use core::ops::Range;
use footfall_core::Side;
use footfall_core::lanes::{COUNTING, LANES, Quatx8, Vec3x8, f32x8, smooth_step};
use footfall_core::rotation::log_map;
use footfall_ik::{FootTarget, FootTargetx8, Plant, RockerFoot};
use glam::Vec3;

/// Least clearance of the sole in the middle of the swing, metres.
const CLEARANCE_M: f32 = 0.012;

/// Distance over which the foot yields to that clearance, metres.
const CLEARANCE_SOFTNESS_M: f32 = 0.004;

/// Rate at which the disagreement from the last stance dies away, per swing.
const SETTLE_RATE: f32 = 8.0;

/// Maximum landing speed of a walking and of a running foot, m/s: people brake their swing before the heel strikes.
const MOST_LANDING_MPS: [f32; 2] = [1.2, 1.5];

/// The same of a switching model's foot in a step to the side or backwards: at more, its knee is turned back within a frame as it lands.
const SOFT_LANDING_MPS: f32 = 0.6;

/// Maximum speed of descent of a walking foot as it lands, m/s.
const MOST_DESCENT_MPS: f32 = 0.22;

/// Part of the swing, or of the flight, after which a foot is independent of its stance.
const FREED_BY: f32 = 0.3;
const DEPARTED_BY: f32 = 0.25;

/// Time after which a leaping foot is independent of its stance, seconds: the hips rise fast and draw the leg with them at once.
const LEAP_DEPARTURE_SECS: f32 = 0.5;

/// Longest time over which a faster foot is braked, seconds.
const BRAKING_SECS: [f32; 2] = [0.16, 0.1];

/// Share of the straight leg to which a swinging leg can be stretched; that of a leg that has taken off, and the share from which it yields.
const SWING_EXTENSION: f32 = 0.9985;
const FLYING_EXTENSIONS: [f32; 2] = [0.965, 0.99];

/// Decrease of those shares, and of the share of a landing leg, as a foot leaves the ground aside or behind: its leg would straighten and bend again within frames. Not for a foot that is in
/// the air as its step is planned anew, for its leg may be straight already.
const LEAVING_ASIDE: [f32; 2] = [0.03, 0.0135];

/// Difference between planted and generated foot, from the last frame of one stance to the first of the next.
pub(super) struct Swing {
    first: usize,
    frames: f32,
    position: Correction,
    rotation: Correction,
    /// The toes' own rotation.
    toes: Correction,
    /// Excess of the landing speed, metres per frame, and the number of frames over which it is braked.
    excess: Vec3,
    braking: f32,
    /// Frames of the swing after which the foot is independent of its stance.
    freed_after: f32,
    /// True for a foot that has just taken off.
    departs: bool,
}

/// A correction at both ends of the swing, and how fast it changes when the foot leaves the ground (per swing).
struct Correction {
    start: Vec3,
    departure: Vec3,
    end: Vec3,
}

impl Correction {
    /// Returns the correction: critically damped from the start, and a smooth approach to the end.
    fn at(&self, share: &Share) -> Vec3x8 {
        let going = Vec3x8::splat(self.departure + self.start * SETTLE_RATE) * share.s;
        let farewell = (Vec3x8::splat(self.start) + going) * share.left;
        farewell + Vec3x8::splat(self.end) * share.smooth
    }
}

impl Swing {
    /// `ends`: the planted and the free foot one frame before the swing, at its start and at its end; `arrival`: where the free
    /// foot is one frame before the end.
    pub(super) fn new(
        ends: &[(FootTarget, FootTarget); 3],
        arrival: Vec3,
        timing: &StepTiming,
        frame_secs: f32,
        lands_softly: bool,
    ) -> Self {
        let first = timing.terminal;
        let frames = (timing.frames - first).max(1) as f32;
        // The corrections have come to rest by then.
        let landing = ends[2].1.ankle - arrival;
        let runs = usize::from(timing.airborne);
        let (usual_mps, braking_secs) = (MOST_LANDING_MPS[runs], BRAKING_SECS[runs]);
        let most_landing_mps = if lands_softly {
            SOFT_LANDING_MPS
        } else {
            usual_mps
        };
        let mut braked = landing.clamp_length_max(most_landing_mps * frame_secs);
        if !timing.airborne {
            braked.y = braked.y.max(-MOST_DESCENT_MPS * frame_secs);
        }
        Self {
            freed_after: if timing.airborne {
                0.0
            } else {
                FREED_BY * frames
            },
            excess: landing - braked,
            braking: (braking_secs / frame_secs).min(frames),
            ..Self::between(&[ends[0], ends[1]], Some(&ends[2]), first, frames)
        }
    }

    /// Begins a swing that the next step ends: `ends` are the planted and the free foot one frame before the take-off and at it.
    pub(super) fn departing(
        ends: &[(FootTarget, FootTarget); 2],
        timing: &StepTiming,
        take_off: usize,
        leaps: bool,
        frame_secs: f32,
    ) -> Self {
        let flight = timing.frames - take_off;
        // The next step is about as long as this one; that after a leap is not.
        let frames = (flight + timing.frames) as f32;
        let frames = if leaps {
            (LEAP_DEPARTURE_SECS / frame_secs).max(1.0)
        } else {
            frames
        };
        Self {
            freed_after: if leaps {
                0.0
            } else {
                DEPARTED_BY * flight as f32
            },
            departs: true,
            ..Self::between(ends, None, take_off, frames)
        }
    }

    /// Makes a swing of this many frames from the frame `first` on; without a landing it follows the free foot.
    fn between(
        starts: &[(FootTarget, FootTarget); 2],
        landing: Option<&(FootTarget, FootTarget)>,
        first: usize,
        frames: f32,
    ) -> Self {
        let correction = |difference: &dyn Fn(&FootTarget, &FootTarget) -> Vec3| {
            let [before, start] = starts
                .each_ref()
                .map(|(planted, free)| difference(planted, free));
            Correction {
                start,
                departure: (start - before) * frames,
                end: landing.map_or(Vec3::ZERO, |(planted, free)| difference(planted, free)),
            }
        };
        Self {
            first,
            frames,
            position: correction(&|planted, free| planted.ankle - free.ankle),
            rotation: correction(&|planted, free| log_map(planted.foot * free.foot.inverse())),
            // Captured toes are too noisy to follow, as most marker sets guess them: from their bend at the end of the stance
            // they go to that of the landing, which is none where the heel lands first.
            toes: correction(&|planted, _| log_map(planted.foot.inverse() * planted.toes)),
            excess: Vec3::ZERO,
            braking: frames,
            freed_after: FREED_BY * frames,
            departs: false,
        }
    }

    /// Returns the feet in eight frames of the step from `index` on, given the free feet.
    pub(super) fn guide(
        &self,
        index: usize,
        free: &FootTargetx8,
        foot: &RockerFoot,
    ) -> FootTargetx8 {
        let passed = self.passed(index);
        let share = Share::of(passed * self.frames.recip());
        let rotation = (Quatx8::exp_map(self.rotation.at(&share)) * free.foot).normalize();
        let mut target = FootTargetx8 {
            ankle: free.ankle + self.position.at(&share),
            foot: rotation,
            toes: rotation * Quatx8::exp_map(self.toes.at(&share)),
        };
        // Ahead at first, to arrive slower.
        let left = f32x8::splat(self.frames) - passed;
        let b = (f32x8::ONE - left * self.braking.recip()).fast_max(f32x8::ZERO);
        let ahead = b * b * (f32x8::ONE - b) * self.braking;
        target.ankle = target.ankle + Vec3x8::splat(self.excess) * ahead;
        let clearance = share.hump * share.hump * CLEARANCE_M;
        let softness = share.hump * CLEARANCE_SOFTNESS_M + f32x8::splat(1e-6);
        let short = (clearance - foot.lowest_points(&target)) / softness;
        target.ankle.y += softness * soft_positive(short);
        target
    }

    /// Progress of the feet away from their stance in eight frames from `index` on, from 0 to 1.
    pub(super) fn freed(&self, index: usize) -> f32x8 {
        if self.freed_after <= 0.0 {
            return f32x8::ONE;
        }
        smooth_step(self.passed(index) * self.freed_after.recip())
    }

    /// Frames of the swing that have passed in eight frames of the step from `index` on.
    fn passed(&self, index: usize) -> f32x8 {
        (COUNTING + f32x8::splat((index - self.first) as f32)).fast_min(f32x8::splat(self.frames))
    }
}

impl Planter {
    /// Fills the targets of a swinging foot in a range of frames, eight at a time.
    pub(super) fn fill_swing(
        &self,
        generated: &mut [GeneratedFrame],
        side: Side,
        within: Range<usize>,
        swing: &Swing,
        frames: &[PlantedFrame],
    ) {
        let side = side.index();
        let extensions = if swing.departs {
            FLYING_EXTENSIONS
        } else {
            [self.landing_extension(), SWING_EXTENSION]
        };
        let aside = if swing.freed_after > 0.0 {
            1.0 - self.state.strafe.uprightness()
        } else {
            0.0
        };
        let leaving = LEAVING_ASIDE.map(|share| share * aside);
        let end = within.end;
        for index in within.step_by(LANES) {
            let at = |lane: usize| (index + lane).min(end - 1);
            let level = Quatx8::gather(|lane| frames[at(lane)].level);
            let hips = Vec3x8::gather(|lane| frames[at(lane)].pose.root_position);
            let leg = |lane: usize| &generated[at(lane)].legs[side];
            let foot = level * Quatx8::gather(|lane| leg(lane).foot);
            let free = FootTargetx8 {
                ankle: hips + level * Vec3x8::gather(|lane| leg(lane).ankle),
                foot,
                toes: foot,
            };
            let hip = hips + level * Vec3x8::gather(|lane| leg(lane).hip);
            let mut target = swing.guide(index, &free, &self.feet[side]);
            let ankle = target.ankle - hip;
            let left = f32x8::ONE - smooth_step(swing.passed(index) * swing.frames.recip());
            let extensions = [0, 1].map(|end| {
                (f32x8::splat(extensions[end]) - left * leaving[end]) * self.leg_lengths[side]
            });
            let yielded = ankle * yielding(ankle.length(), extensions);
            target.ankle = hip + ankle + (yielded - ankle) * swing.freed(index);
            let frames = &mut generated[index..end.min(index + LANES)];
            for (frame, target) in frames.iter_mut().zip(target.lanes()) {
                frame.legs[side].target = target;
            }
        }
    }

    /// Returns the planted and free places of the trailing foot at the ends of its swing.
    pub(super) fn swing_ends(
        &self,
        generated: &[GeneratedFrame],
        timing: &StepTiming,
        frames: &[PlantedFrame],
        next_plant: &Plant,
    ) -> [(FootTarget, FootTarget); 3] {
        let side = timing.leading.other();
        let foot = &self.feet[side.index()];
        let before = timing.terminal.saturating_sub(1);
        [before, timing.terminal, timing.frames].map(|index| {
            let frame = &frames[index];
            let leg = &generated[index].legs[side.index()];
            let planted = if index == timing.frames {
                foot.stand(next_plant, leg.pitch)
            } else {
                leg.target
            };
            let free = free_foot(
                &generated[index],
                side,
                frame.pose.root_position,
                frame.level,
            );
            (planted, free)
        })
    }
}

/// Parts of the swing in eight frames, and values that depend on them alone.
struct Share {
    s: f32x8,
    smooth: f32x8,
    /// Remaining part of the initial correction.
    left: f32x8,
    /// From 0 at the ends to 1 in the middle.
    hump: f32x8,
}

impl Share {
    fn of(s: f32x8) -> Self {
        // Sine and cosine of half the angle that the hump is the sine of.
        let half = Quatx8::from_rotation_x(s * PI);
        Self {
            s,
            smooth: smooth_step(s),
            left: (s * -SETTLE_RATE).exp(),
            hump: half.x * half.w * 2.0,
        }
    }
}

/// The larger of a number and 0, rounded off where they meet.
fn soft_positive(value: f32x8) -> f32x8 {
    // Beyond these it is the plain maximum to the last digit that shows.
    let most = f32x8::splat(10.0);
    let near = value.fast_max(-most).fast_min(most);
    let soft = (f32x8::ONE + near.exp()).ln();
    let soft = value.simd_gt(most).bitselect(value, soft);
    value.simd_lt(-most).bitselect(f32x8::ZERO, soft)
}
