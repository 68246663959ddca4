//! The style sheet: what is to change about a captured walk, in numbers that a person would use.
//!
//! Every key is declared once, in the table below; the parser, the range check, the defaults and the documentation that
//! `footfall design --keys` prints all come from it.

mod parse;
mod write;

use crate::curve::PeriodicCurve;
use core::ops::RangeInclusive;
use footfall_core::Joint;

/// A key of the sheet, for documentation.
#[derive(Clone, Debug, PartialEq)]
pub struct KeySpec {
    /// Table of the sheet, for example `walk`.
    pub section: &'static str,
    /// Key in the table.
    pub key: &'static str,
    /// Unit of the value.
    pub unit: &'static str,
    /// The value that changes nothing.
    pub neutral: f32,
    /// Least and greatest value.
    pub range: RangeInclusive<f32>,
    /// Its effect.
    pub text: &'static str,
}

impl KeySpec {
    /// Returns true when a value changes nothing.
    #[expect(
        clippy::float_cmp,
        reason = "the least change is a change, and the neutral value is written as it is here"
    )]
    pub fn is_neutral(&self, value: f32) -> bool {
        value == self.neutral
    }
}

/// A table of numbers.
trait Section {
    fn value_mut(&mut self, key: &str) -> Option<&mut f32>;
}

macro_rules! sections {
    ($($(#[$about:meta])* $section:ident $name:literal {
        $($key:ident: $neutral:literal, $range:expr, $unit:literal, $text:literal;)*
    })*) => {
        $($(#[$about])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $section {
            $(#[doc = $text] pub $key: f32,)*
        }

        impl Default for $section {
            fn default() -> Self {
                Self { $($key: $neutral,)* }
            }
        }

        impl $section {
            /// Every key of the table under the name that it has in the sheet.
            pub fn keys(section: &'static str) -> Vec<KeySpec> {
                vec![$(KeySpec {
                    section,
                    key: stringify!($key),
                    unit: $unit,
                    neutral: $neutral,
                    range: $range,
                    text: $text,
                },)*]
            }

        }

        impl Section for $section {
            fn value_mut(&mut self, key: &str) -> Option<&mut f32> {
                match key {
                    $(stringify!($key) => Some(&mut self.$key),)*
                    _ => None,
                }
            }
        })*
    };
}

sections! {
    /// `[walk]`: steps in space and time.
    Walk "walk" {
        stride: 100.0, 30.0..=150.0, "%", "Step length relative to the capture.";
        cadence: 100.0, 40.0..=170.0, "%", "Cadence relative to the capture.";
        stance_share: 0.0, -8.0..=15.0, "% of the stride", "Added stance time of each foot; more gives a longer double support.";
        width: 0.0, -25.0..=30.0, "cm", "Added lateral distance between the feet; below zero narrows the walk, at most to a cross-over.";
        toe_out: 0.0, -30.0..=40.0, "degrees", "Turns the toes of both feet out.";
    }
    /// `[feet]`: how they land, push off and swing.
    Feet "feet" {
        landing: 0.0, -40.0..=20.0, "degrees", "Foot pitch at landing: above zero the toes are higher and the heel strikes harder, -20 lands about flat, -35 on the toes.";
        push_off: 100.0, 0.0..=150.0, "%", "Rise of the heel before the foot leaves the ground.";
        heel_raise: 0.0, 0.0..=45.0, "degrees", "Raises the heels permanently: on tiptoe.";
        lift: 0.0, -3.0..=25.0, "cm", "Lifts the swinging foot, and with it the knee, higher.";
    }
    /// `[pelvis]`: height, sway and turns of the hips.
    Pelvis "pelvis" {
        height: 0.0, -25.0..=5.0, "cm", "Raises or lowers the hips; lower bends the knees. Straight legs set an upper limit.";
        bounce: 100.0, 0.0..=300.0, "%", "Vertical motion of the hips. Shorter steps reduce it by themselves.";
        sway: 100.0, 0.0..=300.0, "%", "Lateral motion of the hips.";
        sway_more: 0.0, -5.0..=10.0, "cm", "Added sway to each side, towards the standing foot.";
        tilt: 0.0, -20.0..=25.0, "degrees", "Tilts the pelvis forward; the trunk keeps its pose.";
        list: 0.0, -10.0..=20.0, "degrees", "Added drop of the swinging side, to each side: rolling hips.";
        turn: 0.0, -10.0..=20.0, "degrees", "Added turn that brings the hip of the stepping leg forward, to each side.";
    }
    /// `[trunk]`: from waist to shoulders.
    Trunk "trunk" {
        lean: 0.0, -20.0..=45.0, "degrees", "Leans the trunk forward from the waist.";
        slump: 0.0, -25.0..=45.0, "degrees", "Rounds the upper back; below zero pushes the chest out.";
        side_lean: 0.0, -25.0..=25.0, "degrees", "Leans the trunk to its left permanently.";
        sway: 0.0, -10.0..=15.0, "degrees", "Added lean over the standing foot, to each side.";
        turn: 0.0, -15.0..=20.0, "degrees", "Added turn of the shoulders relative to the hips, to each side.";
        amplitude: 100.0, 0.0..=300.0, "%", "Motion of the trunk about its mean posture.";
    }
    /// `[head]`: where the face points.
    Head "head" {
        pitch: 0.0, -35.0..=50.0, "degrees", "Lowers the face, whatever the trunk does: 30 looks at the ground.";
        turn: 0.0, -60.0..=60.0, "degrees", "Turns the face to its left.";
        tilt: 0.0, -30.0..=30.0, "degrees", "Tilts the head towards the left shoulder.";
        amplitude: 100.0, 0.0..=300.0, "%", "Motion of the head about its mean posture.";
    }
    /// `[shoulders]`: the shoulder girdle.
    Shoulders "shoulders" {
        raise: 0.0, -15.0..=30.0, "degrees", "Raises both shoulders; below zero lets them drop.";
        forward: 0.0, -25.0..=30.0, "degrees", "Brings both shoulders forward; below zero draws them back.";
    }
    /// `[arms]`: swing and carriage of both arms.
    Arms "arms" {
        swing: 100.0, 0.0..=250.0, "%", "Swing of the upper arms.";
        elbow_swing: 100.0, 0.0..=250.0, "%", "Bending and stretching of the elbows with the swing.";
        forward: 0.0, -40.0..=90.0, "degrees", "Carries the upper arms further forward.";
        out: 0.0, -15.0..=70.0, "degrees", "Carries the upper arms further from the body.";
        elbow: 0.0, -30.0..=120.0, "degrees", "Bends the elbows more.";
        turn_in: 0.0, -60.0..=90.0, "degrees", "Turns the arms about their own length so that bent forearms point inward.";
    }
    /// `[left]` and `[right]`: what one side does differently, for limps and habits.
    OneSide "left" {
        step_length: 100.0, 50.0..=130.0, "%", "Length of the step that ends with this foot.";
        step_time: 100.0, 60.0..=150.0, "%", "Time for which this foot carries the body; shorter spares the leg.";
        drop: 0.0, -5.0..=10.0, "cm", "Drop of the hips while this foot carries the body.";
        lift: 0.0, -3.0..=20.0, "cm", "Lifts this foot higher in its swing.";
        arm_swing: 100.0, 0.0..=250.0, "%", "Swing of this arm.";
    }
    /// `[irregular]`: chance, anew for every step; the numbers are standard deviations.
    Irregular "irregular" {
        step_length: 0.0, 0.0..=25.0, "%", "Irregularity of the step length.";
        step_time: 0.0, 0.0..=25.0, "%", "Irregularity of the step time.";
        step_width: 0.0, 0.0..=10.0, "cm", "Irregularity of the lateral landing place.";
        wander: 0.0, 0.0..=25.0, "cm", "Amplitude of a slow weave off the straight path.";
        trunk: 0.0, 0.0..=10.0, "degrees", "Amplitude of a slow lean and sway of the trunk.";
        head: 0.0, 0.0..=15.0, "degrees", "Amplitude of slow turns and nods of the head.";
        arms: 0.0, 0.0..=20.0, "degrees", "Amplitude of slow movements of the arms.";
        period: 1.6, 0.6..=6.0, "seconds", "Period of the slow movements.";
    }
    /// `[joints.NAME]`: any joint by its name.
    JointEdit "joints.NAME" {
        pitch: 0.0, -90.0..=90.0, "degrees", "Turns the joint about the left-right axis of its parent; a trunk leans forward, a hanging arm goes back.";
        yaw: 0.0, -90.0..=90.0, "degrees", "Turns the joint about the up axis of its parent, to the left.";
        roll: 0.0, -90.0..=90.0, "degrees", "Turns the joint about the forward axis of its parent; a trunk leans right, a left arm rises.";
        amplitude: 100.0, 0.0..=300.0, "%", "Motion of the joint about its mean.";
    }
}

/// Axis of a `[[curve]]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// About the left-right axis of the parent.
    Pitch,
    /// About the up axis of the parent.
    Yaw,
    /// About the forward axis of the parent.
    Roll,
}

/// `[[curve]]`: an offset and an amplitude of one joint that repeat with the gait cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct PhaseCurve {
    /// The joint.
    pub joint: Joint,
    /// Axis of the turn.
    pub axis: Axis,
    /// Degrees over the cycle, which starts when the joint's own foot lands (the left one for the trunk).
    pub offset: PeriodicCurve,
    /// Percent of the joint's movement about its mean, over the cycle.
    pub amplitude: PeriodicCurve,
}

/// A whole sheet.
#[derive(Clone, Debug, Default, PartialEq)]
#[expect(missing_docs, reason = "the tables are documented on their types")]
pub struct StyleSheet {
    /// Name of the style.
    pub name: String,
    /// One sentence on it.
    pub summary: String,
    pub walk: Walk,
    pub feet: Feet,
    pub pelvis: Pelvis,
    pub trunk: Trunk,
    pub head: Head,
    pub shoulders: Shoulders,
    pub arms: Arms,
    /// Left, then right.
    pub sides: [OneSide; 2],
    pub irregular: Irregular,
    /// Edits of single joints.
    pub joints: Vec<(Joint, JointEdit)>,
    /// Edits that follow the gait cycle.
    pub curves: Vec<PhaseCurve>,
}

impl StyleSheet {
    /// Returns true when the sheet asks for no change at all.
    pub fn is_neutral(&self) -> bool {
        let named = Self {
            name: self.name.clone(),
            summary: self.summary.clone(),
            ..Self::default()
        };
        *self == named
    }

    /// Every key that a sheet may have, in reading order.
    pub fn keys() -> Vec<KeySpec> {
        [
            Walk::keys("walk"),
            Feet::keys("feet"),
            Pelvis::keys("pelvis"),
            Trunk::keys("trunk"),
            Head::keys("head"),
            Shoulders::keys("shoulders"),
            Arms::keys("arms"),
            OneSide::keys("left"),
            OneSide::keys("right"),
            Irregular::keys("irregular"),
            JointEdit::keys("joints.NAME"),
        ]
        .concat()
    }
}

/// Error of reading a sheet.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what}")]
pub struct SheetError {
    /// Line of the sheet, from 1.
    pub line: usize,
    /// The fault, and what to write instead.
    pub what: String,
}
