//! Contact sheets: motion on one page, to be judged by eye.
//!
//! For each clip: figures that travel at true scale over the floor, the path from above with its footfalls, poses over
//! time from the side and from the front, contact bars and joint curves.

mod curves;
mod draw;
mod figure;
mod layout;
mod measure;
mod panels;

use anyhow::Result;
use draw::Canvas;
use footfall_core::{Clip, FrameSpan};
use glam::Vec2;
use layout::Block;
use measure::Measured;

/// One clip with what is said about it.
pub(crate) struct Subject {
    /// File name.
    pub(crate) title: String,
    /// Facts that stand beside the title.
    pub(crate) note: String,
    /// The motion, on the canonical body's joints.
    pub(crate) clip: Clip,
    /// Stances of the left and of the right foot, in frames of the clip.
    pub(crate) stances: [Vec<FrameSpan>; 2],
}

/// Part of a clip that is drawn, and the size of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SheetOptions {
    /// First moment shown, seconds from frame 0.
    pub(crate) start_secs: f64,
    /// Length to draw; to the end when `None`.
    pub(crate) seconds: Option<f64>,
    /// Figures in each pose strip.
    pub(crate) poses: usize,
    /// Pixels across.
    pub(crate) width: u32,
}

/// Draws every subject below the one before; 8-bit RGB rows with their width and height.
///
/// # Errors
/// A clip that has fewer than two frames in the window, or a picture too large for memory.
pub(crate) fn draw_sheet(
    subjects: &[Subject],
    options: &SheetOptions,
) -> Result<(u32, u32, Vec<u8>)> {
    let measured = subjects
        .iter()
        .map(|subject| Measured::new(subject, options))
        .collect::<Result<Vec<_>>>()?;
    let blocks: Vec<Block> = measured
        .iter()
        .map(|measured| Block::new(measured, options))
        .collect();
    let height: f32 = blocks.iter().map(|block| block.height).sum();
    let mut canvas = Canvas::new(options.width, height.ceil() as u32)?;
    let mut top = 0.0;
    for ((subject, measured), block) in subjects.iter().zip(&measured).zip(&blocks) {
        panels::draw_block(&mut canvas, subject, measured, block, Vec2::new(0.0, top));
        top += block.height;
    }
    Ok(canvas.into_rgb())
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_core::rotation::exp_map;
    use footfall_core::{Joint, Pose, Side, Skeleton};
    use glam::Vec3;

    /// A body that swings its legs as pendulums while it travels: enough to exercise every panel.
    pub(crate) fn swinging(frames: usize) -> Subject {
        let skeleton = Skeleton::standard();
        let poses = (0..frames)
            .map(|frame| {
                let time = frame as f32 / 60.0;
                let mut pose = Pose::rest(&skeleton);
                pose.root_position.z = 1.2 * time;
                for side in Side::BOTH {
                    let phase = std::f32::consts::TAU * (0.9 * time)
                        + if side == Side::Left {
                            0.0
                        } else {
                            std::f32::consts::PI
                        };
                    let mut turn = |joint: Joint, axis: Vec3, angle: f32| {
                        pose.rotations[joint.index()] = exp_map(axis * angle);
                    };
                    turn(side.upper_leg(), Vec3::NEG_X, 0.4 * phase.sin());
                    turn(side.lower_leg(), Vec3::X, 0.4 - 0.4 * phase.cos());
                    let arm = if side == Side::Left {
                        Joint::LeftUpperArm
                    } else {
                        Joint::RightUpperArm
                    };
                    turn(arm, Vec3::NEG_Z, 1.3 * side.sign());
                }
                pose
            })
            .collect();
        Subject {
            title: "swing.bvh".to_owned(),
            note: "canonical body".to_owned(),
            clip: Clip {
                skeleton,
                frame_rate_hz: 60.0,
                poses,
            },
            stances: [
                vec![FrameSpan {
                    first: 10,
                    last: 45,
                }],
                vec![FrameSpan {
                    first: 40,
                    last: 80,
                }],
            ],
        }
    }

    const OPTIONS: SheetOptions = SheetOptions {
        start_secs: 0.0,
        seconds: None,
        poses: 14,
        width: 1800,
    };

    #[test]
    fn both_legs_both_colours_and_the_bars_are_drawn() {
        let (width, height, rgb) = draw_sheet(&[swinging(181), swinging(60)], &OPTIONS).unwrap();
        assert_eq!(width, 1800);
        assert_eq!(rgb.len(), (width * height * 3) as usize);
        for color in [
            draw::palette::LEFT,
            draw::palette::RIGHT,
            draw::palette::TRUNK,
        ] {
            let count = rgb.chunks_exact(3).filter(|pixel| *pixel == color).count();
            assert!(count > 2000, "{color:?}: {count} pixels");
        }
        if let Ok(path) = std::env::var("FOOTFALL_SHEET_PREVIEW") {
            image::save_buffer(path, &rgb, width, height, image::ExtendedColorType::Rgb8).unwrap();
        }
    }

    #[test]
    fn a_window_past_the_end_is_refused_with_the_length() {
        let options = SheetOptions {
            start_secs: 9.0,
            ..OPTIONS
        };
        let error = draw_sheet(&[swinging(61)], &options)
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("swing.bvh") && error.contains("1.0"),
            "{error}"
        );
    }
}
