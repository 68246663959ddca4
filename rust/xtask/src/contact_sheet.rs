//! Many pictures on one sheet.

use anyhow::{Context as _, Result, bail};
use image::imageops::{self, FilterType};
use image::{Rgb, RgbImage};
use std::fs;
use std::path::{Path, PathBuf};

/// Width of one picture on the sheet, pixels.
const WIDTH: u32 = 480;
const COLUMNS: usize = 4;
const GAP: u32 = 6;
/// More pictures than this are thinned out evenly.
const MOST: usize = 16;

/// The pictures `frame_*.png` of a folder, in order.
pub(crate) fn pictures(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries =
        fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            name.starts_with("frame_") && name.ends_with(".png")
        })
        .collect();
    files.sort();
    Ok(files)
}

/// Puts pictures of one size on a sheet.
///
/// # Errors
/// When there is no picture, or one cannot be read or the sheet not be written.
pub(crate) fn write(pictures: &[PathBuf], sheet: &Path) -> Result<()> {
    let shown: Vec<&PathBuf> = thinned(pictures.len())
        .into_iter()
        .map(|index| &pictures[index])
        .collect();
    let Some(first) = shown.first() else {
        bail!("there are no pictures to put on a sheet")
    };
    let (width, height) = image::image_dimensions(first)
        .with_context(|| format!("cannot read {}", first.display()))?;
    let height = (height * WIDTH / width.max(1)).max(1);
    let columns = shown.len().min(COLUMNS) as u32;
    let rows = shown.len().div_ceil(COLUMNS) as u32;
    let size = (columns * (WIDTH + GAP) + GAP, rows * (height + GAP) + GAP);
    let mut canvas = RgbImage::from_pixel(size.0, size.1, Rgb([24, 26, 30]));
    for (index, file) in shown.iter().enumerate() {
        let picture = image::open(file)
            .with_context(|| format!("cannot read {}", file.display()))?
            .to_rgb8();
        let small = imageops::resize(&picture, WIDTH, height, FilterType::Triangle);
        let (column, row) = ((index % COLUMNS) as u32, (index / COLUMNS) as u32);
        let (x, y) = (GAP + column * (WIDTH + GAP), GAP + row * (height + GAP));
        imageops::replace(&mut canvas, &small, i64::from(x), i64::from(y));
    }
    canvas
        .save(sheet)
        .with_context(|| format!("cannot write {}", sheet.display()))
}

/// At most [`MOST`] of so many pictures, evenly spread, the first and the last included.
fn thinned(count: usize) -> Vec<usize> {
    if count <= MOST {
        return (0..count).collect();
    }
    (0..MOST)
        .map(|place| place * (count - 1) / (MOST - 1))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_pictures_are_thinned_evenly() {
        assert_eq!(thinned(3), [0, 1, 2]);
        let some = thinned(100);
        assert_eq!((some.len(), some[0], some[MOST - 1]), (MOST, 0, 99));
    }

    #[test]
    fn a_sheet_shows_each_picture_in_its_place() {
        let folder = std::env::temp_dir().join(format!("footfall_sheet_{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        for (index, colour) in [
            [255, 0, 0],
            [0, 255, 0],
            [0, 0, 255],
            [255, 255, 0],
            [255, 0, 255],
        ]
        .iter()
        .enumerate()
        {
            RgbImage::from_pixel(64, 36, Rgb(*colour))
                .save(folder.join(format!("frame_{index:04}.png")))
                .unwrap();
        }
        fs::write(folder.join("other.png"), "no picture").unwrap();
        let pictures = pictures(&folder).unwrap();
        assert_eq!(pictures.len(), 5);
        let sheet = folder.join("sheet.png");
        write(&pictures, &sheet).unwrap();
        let sheet = image::open(&sheet).unwrap().to_rgb8();
        let height = 36 * WIDTH / 64;
        assert_eq!(
            sheet.dimensions(),
            (4 * (WIDTH + GAP) + GAP, 2 * (height + GAP) + GAP)
        );
        assert_eq!(
            sheet.get_pixel(GAP + WIDTH + GAP + 9, GAP + 9).0,
            [0, 255, 0]
        );
        assert_eq!(
            sheet.get_pixel(GAP + 9, GAP + height + GAP + 9).0,
            [255, 0, 255]
        );
        assert!(write(&[], &folder.join("none.png")).is_err());
        fs::remove_dir_all(folder).unwrap();
    }
}
