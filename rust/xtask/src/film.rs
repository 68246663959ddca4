//! `cargo xtask film`: the moving picture that the README opens with.

use crate::demo::Stage;
use crate::{contact_sheet, engine_run, paths};
use anyhow::{Context as _, Result, bail};
use gif::{DisposalMethod, Encoder, Frame, Repeat};
use image::imageops::{self, FilterType};
use image::{Rgba, RgbaImage};
use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;

const SCENE: &str = "res://scenes/town/town.tscn";
const PICTURE: &str = "demo_project/pictures/tour.gif";
/// Size of the film, pixels, and pictures a second as the scene saves them.
const SIZE: (u16, u16) = (368, 207);
const RATE_HZ: u16 = 12;
/// Bits of each colour that are kept: fewer colours make smaller files.
const COLOUR_BITS: u32 = 5;
/// Speed of the choice of colours, from 1, best, to 30.
const QUANTISED_AT: i32 = 10;

/// Films the tour of the town.
///
/// # Errors
/// When a part cannot be built or had, the scene fails, or the film cannot be written.
pub(crate) fn command() -> Result<()> {
    let stage = Stage::build("film")?;
    let folder = paths::target_folder().join("film");
    paths::make_empty(&folder)?;
    let mut command = stage.godot();
    command
        .args([SCENE, "--fixed-fps", "60", "--resolution", "960x540"])
        .args(["--", "--film"])
        .arg(&folder);
    engine_run::judged(&mut command, &folder.join("godot.log"))?;
    let film = paths::repository_root().join(PICTURE);
    write(&contact_sheet::pictures(&folder)?, &film)?;
    println!("{}", film.display());
    Ok(())
}

/// Writes pictures as a film that repeats. Of each only what has changed is kept.
fn write(pictures: &[PathBuf], film: &std::path::Path) -> Result<()> {
    if pictures.is_empty() {
        bail!("the scene rendered no pictures for the film")
    }
    let file = File::create(film).with_context(|| format!("cannot write {}", film.display()))?;
    let mut encoder = Encoder::new(BufWriter::new(file), SIZE.0, SIZE.1, &[])?;
    encoder.set_repeat(Repeat::Infinite)?;
    let mut before: Option<RgbaImage> = None;
    for path in pictures {
        let picture = image::open(path)
            .with_context(|| format!("cannot read {}", path.display()))?
            .to_rgba8();
        let mut small =
            imageops::resize(&picture, SIZE.0.into(), SIZE.1.into(), FilterType::Triangle);
        for pixel in small.pixels_mut() {
            *pixel = reduced(*pixel);
        }
        let mut news = changed(before.as_ref(), &small).into_raw();
        let mut frame = Frame::from_rgba_speed(SIZE.0, SIZE.1, &mut news, QUANTISED_AT);
        frame.delay = 100 / RATE_HZ;
        frame.dispose = DisposalMethod::Keep;
        encoder.write_frame(&frame)?;
        before = Some(small);
    }
    Ok(())
}

/// A colour among fewer.
fn reduced(Rgba([red, green, blue, _]): Rgba<u8>) -> Rgba<u8> {
    let step = 1 << (8 - COLOUR_BITS);
    let rounded = |value: u8| (value / step * step).saturating_add(step / 2);
    Rgba([rounded(red), rounded(green), rounded(blue), u8::MAX])
}

/// A picture with nothing where the one before shows the same.
fn changed(before: Option<&RgbaImage>, now: &RgbaImage) -> RgbaImage {
    let mut news = now.clone();
    if let Some(before) = before {
        for (pixel, before) in news.pixels_mut().zip(before.pixels()) {
            if pixel == before {
                *pixel = Rgba([0; 4]);
            }
        }
    }
    news
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_film_keeps_what_has_changed() {
        let first = RgbaImage::from_pixel(4, 2, reduced(Rgba([10, 20, 30, 255])));
        let mut second = first.clone();
        second.put_pixel(3, 1, reduced(Rgba([200, 20, 30, 255])));
        let news = changed(Some(&first), &second);
        assert_eq!(news.pixels().filter(|pixel| pixel.0[3] > 0).count(), 1);
        assert_eq!(news.get_pixel(3, 1), second.get_pixel(3, 1));
        assert_eq!(changed(None, &first), first);
    }
}
