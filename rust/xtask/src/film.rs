//! `cargo xtask film`: the moving picture that the README opens with.

use crate::demo::Stage;
use crate::{contact_sheet, engine_run, paths, process, webp};
use anyhow::{Context as _, Result, bail};
use image::imageops::{self, FilterType};
use std::path::{Path, PathBuf};

const SCENE: &str = "res://scenes/town/town.tscn";
const PICTURE: &str = "demo_project/pictures/tour.webp";
/// Size of the film, pixels, and pictures a second as the scene saves them.
const SIZE: (u32, u32) = (560, 315);
const RATE_HZ: u32 = 20;
/// Quality of its pictures, from 0 to 100: the film keeps to the size that a file of the repository may have.
const QUALITY: u32 = 36;

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

/// Writes pictures as a film that repeats.
fn write(pictures: &[PathBuf], film: &Path) -> Result<()> {
    if pictures.is_empty() {
        bail!("the scene rendered no pictures for the film")
    }
    for picture in pictures {
        shrink(picture)?;
    }
    let mut command = webp::provision()?;
    command
        .args(["-loop", "0", "-lossy", "-m", "6"])
        .args(["-q", &QUALITY.to_string()])
        .args(["-d", &(1000 / RATE_HZ).to_string()])
        .args(pictures)
        .arg("-o")
        .arg(film);
    process::run(&mut command)
}

/// Makes a picture as small as the film.
fn shrink(path: &Path) -> Result<()> {
    let picture = image::open(path).with_context(|| format!("cannot read {}", path.display()))?;
    imageops::resize(&picture.to_rgb8(), SIZE.0, SIZE.1, FilterType::Triangle)
        .save(path)
        .with_context(|| format!("cannot write {}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{Rgb, RgbImage};

    #[test]
    fn pictures_become_as_small_as_the_film() {
        let folder = std::env::temp_dir().join(format!("footfall_film_{}", std::process::id()));
        paths::make_empty(&folder).unwrap();
        let path = folder.join("frame_0000.png");
        RgbImage::from_pixel(960, 540, Rgb([10, 20, 30]))
            .save(&path)
            .unwrap();
        shrink(&path).unwrap();
        let small = image::open(&path).unwrap().to_rgb8();
        assert_eq!(small.dimensions(), SIZE);
        assert!(small.pixels().all(|pixel| pixel.0 == [10, 20, 30]));
        std::fs::remove_dir_all(folder).unwrap();
    }
}
