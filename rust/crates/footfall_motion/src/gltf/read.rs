//! Animations of `.glb` and `.gltf` files as recordings. `file.glb#Name` is one of several.

use super::buffers::{self, BufferError};
use super::sample::{Local, Track};
use crate::bvh::BvhFile;
use crate::skeletal::{Bone, SkeletalMotion};
use glam::Affine3A;
use gltf::{Animation, Document};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Rate of animations whose keys are too sparse to determine one, frames per second.
const USUAL_RATE_HZ: f64 = 30.0;
/// Rates that are believed.
const PLAUSIBLE_RATES_HZ: std::ops::RangeInclusive<f64> = 15.0..=240.0;
/// Longest animation that is read: a damaged time must not fill the memory.
const LONGEST_SECS: f32 = 3600.0;

/// Errors of reading a recording from a glTF file.
#[derive(Debug, thiserror::Error)]
pub enum GltfError {
    /// The file cannot be read.
    #[error("{}: {source}; check that the file exists and is glTF 2.0, or export it again as .glb", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Fault.
        source: gltf::Error,
    },
    /// The numbers of its animations cannot be read.
    #[error("{}: buffer {index}: {source}; put the file's buffers beside it, or export it again as .glb", path.display())]
    Buffer {
        /// The file.
        path: PathBuf,
        /// The buffer, counted from 0.
        index: usize,
        /// Fault.
        source: BufferError,
    },
    /// No animation turns a bone.
    #[error("{}: no animation moves a skeleton; export the character with its animation", path.display())]
    NoAnimation {
        /// The file.
        path: PathBuf,
    },
    /// Nothing says which of several animations is meant, or it says one that is not there.
    #[error(
        "{}: {wrong}; write one of {}", path.display(),
        names.iter().map(|name| format!("{}#{name}", path.file_name().unwrap_or_default().display())).collect::<Vec<_>>().join(", ")
    )]
    WhichAnimation {
        /// The file.
        path: PathBuf,
        /// The problem with what was asked for.
        wrong: String,
        /// Names of the existing animations.
        names: Vec<String>,
    },
}

/// Returns true for the path of a glTF file, with or without `#Name`.
pub fn is_gltf(path: &Path) -> bool {
    let (file, _) = split_name(path);
    let extension = file.extension().unwrap_or_default().to_ascii_lowercase();
    extension == "glb" || extension == "gltf"
}

/// The animations of a file that move a skeleton, in the file's order; only the one that the path names, if it does.
///
/// # Errors
/// [`GltfError::File`] for a file that cannot be read.
pub fn animation_names(path: &Path) -> Result<Vec<String>, GltfError> {
    let (file, wanted) = split_name(path);
    let opened = open(&file)?;
    let names = opened.animations().map(|named| named.0);
    Ok(names
        .filter(|name| wanted.as_ref().is_none_or(|wanted| wanted == name))
        .collect())
}

/// Reads an animation as a recording; the file may be followed by `#` and the animation's name.
///
/// # Errors
/// [`GltfError`] names the file, and the animations where one has to be chosen.
pub fn read(path: &Path) -> Result<BvhFile, GltfError> {
    let (file, wanted) = split_name(path);
    let opened = open(&file)?;
    let all: Vec<(String, Vec<Track>)> = opened.animations().collect();
    if all.is_empty() {
        return Err(GltfError::NoAnimation { path: file });
    }
    let names: Vec<String> = all.iter().map(|named| named.0.clone()).collect();
    let which = |wrong: String| GltfError::WhichAnimation {
        path: file.clone(),
        wrong,
        names: names.clone(),
    };
    let chosen = match &wanted {
        None if all.len() == 1 => 0,
        None => return Err(which(format!("it has {} animations", all.len()))),
        Some(wanted) => names
            .iter()
            .position(|name| name == wanted)
            .ok_or_else(|| which(format!("it has no animation \"{wanted}\"")))?,
    };
    Ok(opened.motion(&all[chosen].1).to_recording())
}

/// The file and the animation's name behind `#`, unless a file has that very name.
fn split_name(path: &Path) -> (PathBuf, Option<String>) {
    let text = path.to_string_lossy();
    match text.rsplit_once('#') {
        Some((file, name)) if !path.is_file() => (PathBuf::from(file), Some(name.to_owned())),
        _ => (path.to_owned(), None),
    }
}

struct Opened {
    document: Document,
    buffers: Vec<Vec<u8>>,
}

fn open(path: &Path) -> Result<Opened, GltfError> {
    let failed = |source: gltf::Error| GltfError::File {
        path: path.to_owned(),
        source,
    };
    let gltf::Gltf { document, blob } = gltf::Gltf::open(path).map_err(failed)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let buffers = buffers::read(&document, blob, folder);
    let buffers = buffers.map_err(|(index, source)| GltfError::Buffer {
        path: path.to_owned(),
        index,
        source,
    })?;
    Ok(Opened { document, buffers })
}

impl Opened {
    /// Names and tracks of the animations that turn bones.
    fn animations(&self) -> impl Iterator<Item = (String, Vec<Track>)> {
        let bones = self.bones();
        self.document.animations().filter_map(move |animation| {
            let tracks = self.tracks(&animation);
            let turns_bones = tracks
                .iter()
                .any(|track| track.is_rotation() && bones.contains(&track.node));
            let unnamed = || format!("animation {}", animation.index());
            let name = animation.name().map_or_else(unnamed, str::to_owned);
            turns_bones.then_some((name, tracks))
        })
    }

    fn tracks(&self, animation: &Animation<'_>) -> Vec<Track> {
        let channels = animation.channels();
        channels
            .filter_map(|channel| Track::read(&channel, &self.buffers))
            .collect()
    }

    /// The nodes that skins call joints; all nodes where there is no skin.
    fn bones(&self) -> BTreeSet<usize> {
        let skins = self.document.skins();
        let joints: BTreeSet<usize> = skins
            .flat_map(|skin| skin.joints().map(|joint| joint.index()).collect::<Vec<_>>())
            .collect();
        if joints.is_empty() {
            self.document.nodes().map(|node| node.index()).collect()
        } else {
            joints
        }
    }

    fn motion(&self, tracks: &[Track]) -> SkeletalMotion {
        let nodes: Vec<gltf::Node<'_>> = self.document.nodes().collect();
        let rest: Vec<Local> = nodes.iter().map(Local::of).collect();
        let mut parents = vec![None; nodes.len()];
        for node in &nodes {
            for child in node.children() {
                parents[child.index()] = Some(node.index());
            }
        }
        let bones: Vec<usize> = self.bones().into_iter().collect();
        let places: BTreeMap<usize, usize> = bones
            .iter()
            .enumerate()
            .map(|(n, &node)| (node, n))
            .collect();
        let above = |node: usize| {
            let mut chain = std::iter::successors(parents[node], |&node| parents[node]);
            chain.find_map(|node| places.get(&node).copied())
        };
        let posed = |locals: &[Local]| -> Vec<Affine3A> {
            bones
                .iter()
                .map(|&bone| {
                    let chain = std::iter::successors(Some(bone), |&node| parents[node]);
                    chain.fold(Affine3A::IDENTITY, |below, node| {
                        locals[node].affine() * below
                    })
                })
                .collect()
        };
        let at_rest = posed(&rest);
        let first = tracks.iter().map(|track| track.times[0]);
        let first = first.fold(f32::INFINITY, f32::min);
        let last = tracks
            .iter()
            .filter_map(|track| track.times.last().copied());
        let last = last.fold(first, f32::max).min(first + LONGEST_SECS);
        let frame_rate_hz = rate(tracks);
        let count = (f64::from(last - first) * frame_rate_hz).round() as usize + 1;
        let frames = (0..count).map(|frame| {
            let time = first + (frame as f64 / frame_rate_hz) as f32;
            let mut locals = rest.clone();
            for track in tracks {
                track.pose(time, &mut locals[track.node]);
            }
            posed(&locals)
        });
        let named = |node: usize| {
            let unnamed = || format!("node {node}");
            nodes[node].name().map_or_else(unnamed, str::to_owned)
        };
        SkeletalMotion {
            frames: frames.collect(),
            frame_rate_hz,
            bones: bones
                .iter()
                .zip(at_rest)
                .map(|(&node, rest)| Bone {
                    name: named(node),
                    parent: above(node),
                    rest,
                })
                .collect(),
        }
    }
}

/// The rate at which the keys were made: the least distance between two of one track.
fn rate(tracks: &[Track]) -> f64 {
    let spans = tracks.iter().flat_map(|track| {
        track
            .times
            .windows(2)
            .map(|pair| f64::from(pair[1] - pair[0]))
    });
    let least = spans
        .filter(|&span| span > 0.9 / PLAUSIBLE_RATES_HZ.end())
        .fold(f64::INFINITY, f64::min);
    let found = 1.0 / least;
    if !PLAUSIBLE_RATES_HZ.contains(&found) {
        return USUAL_RATE_HZ;
    }
    // Times are in single precision and often rounded to milliseconds.
    if (found - found.round()).abs() < 0.02 * found {
        found.round()
    } else {
        found
    }
}
