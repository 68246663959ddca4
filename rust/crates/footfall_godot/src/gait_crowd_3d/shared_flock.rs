//! Walkers far away, who share their poses: a texture that is written once, and one instance each.

use super::bounds::Bounds;
use super::crowd_mesh::CrowdMesh;
use super::flock::{Flock, POSE_BYTES, write_pose};
use super::instances::{INSTANCE_NUMBERS, draws_in_srgb, write_instance};
use super::scene::{DrawSettings, is_seen};
use footfall_core::{JOINT_COUNT, Joint};
use footfall_rig::crowd::{Crowd, FETCHED, GROUPS, Tier};
use footfall_synth::{CrowdPose, StyledBody};
use glam::Vec4;
use godot::classes::{Node, Node3D};
use godot::prelude::*;
use rayon::prelude::*;

/// Rows that one thread looks through at a time.
const ROWS: usize = 1024;
/// Room grows by half.
const GROWTH: (usize, usize) = (3, 2);

/// Walkers that are drawn with the same mesh, and the number of their rows.
#[derive(Debug, Clone)]
struct Part {
    shown: Vec<u32>,
    bounds: Bounds,
}

/// Instances of all who share poses.
pub(super) struct SharedFlock {
    flock: Flock,
    poses: usize,
    /// Mixtures of styles whose poses are there, and the slot of the first of each.
    bodies: Vec<StyledBody>,
    firsts: Vec<usize>,
    /// Slots that are taken.
    taken: usize,
    /// Mixtures that were written into each of the two buffers.
    written: [usize; 2],
    /// With the character's mesh, and with its stand-in.
    parts: Vec<[Part; 2]>,
    /// True where instances have their colours in sRGB.
    in_srgb: bool,
}

/// A frame's settings, the same for all instances.
struct Shown<'a> {
    walkers: &'a Crowd,
    firsts: &'a [usize],
    in_srgb: bool,
}

impl SharedFlock {
    /// Without room for anybody yet.
    pub(super) fn new(host: &Gd<Node3D>, mesh: &CrowdMesh, look: &DrawSettings) -> Option<Self> {
        Some(Self {
            flock: flock(host, mesh, 1, look)?,
            poses: 1,
            bodies: Vec::new(),
            firsts: Vec::new(),
            taken: 0,
            written: [0; 2],
            parts: Vec::new(),
            in_srgb: draws_in_srgb(),
        })
    }

    /// Makes space for all walkers and for new style mixtures.
    fn fit(&mut self, walkers: &Crowd, host: &Gd<Node3D>, mesh: &CrowdMesh, look: &DrawSettings) {
        let rows = walkers.agents().len();
        let part = Part {
            shown: Vec::with_capacity(ROWS),
            bounds: Bounds::default(),
        };
        self.parts.resize(rows.div_ceil(ROWS), [part.clone(), part]);
        if walkers.worn() > self.bodies.len() {
            for body in walkers.worn_from(self.bodies.len() as u32) {
                self.firsts.push(self.taken);
                self.taken += body.shared_poses();
                self.bodies.push(body);
            }
        }
        let poses = self.taken.max(self.poses * GROWTH.0 / GROWTH.1);
        if self.taken > self.poses
            && let Some(made) = flock(host, mesh, poses, look)
        {
            core::mem::replace(&mut self.flock, made).free();
            self.poses = poses;
            self.written = [0; 2];
        }
        self.write_poses(&mesh.turned_by);
    }

    /// Writes the poses of new style mixtures.
    fn write_poses(&mut self, turned_by: &[Joint; JOINT_COUNT]) {
        let all = self.bodies.len();
        if self.written.contains(&all) || self.taken > self.poses {
            return;
        }
        let turn = self.flock.turn();
        let out = self.flock.poses();
        let mut pose = CrowdPose::default();
        for body in self.written[turn]..all {
            let first = self.firsts[body];
            let slots = out[first * POSE_BYTES..].chunks_exact_mut(POSE_BYTES);
            for (index, out) in slots.take(self.bodies[body].shared_poses()).enumerate() {
                self.bodies[body].shared_pose(index, &mut pose);
                write_pose(&pose, turned_by, out);
            }
        }
        self.written[turn] = all;
        self.flock.upload_poses();
    }

    /// Draws the visible walkers with shared poses, the small ones with the stand-in.
    pub(super) fn draw(
        &mut self,
        walkers: &Crowd,
        (planes, small): (&[Vec4], &[bool]),
        (host, mesh, look): (&Gd<Node3D>, &CrowdMesh, &DrawSettings),
    ) {
        self.fit(walkers, host, mesh, look);
        let (tiers, drawn) = (walkers.tiers(), walkers.drawn());
        self.parts
            .par_iter_mut()
            .enumerate()
            .for_each(|(part, out)| {
                for out in &mut *out {
                    out.shown.clear();
                    out.bounds = Bounds::default();
                }
                let rows = part * ROWS..drawn.len().min((part + 1) * ROWS);
                for row in rows {
                    let place = drawn[row].places[1];
                    if tiers[row] == Tier::Far && walkers.shares(row) && is_seen(place, planes) {
                        let out = &mut out[usize::from(small[row])];
                        out.shown.push(row as u32);
                        out.bounds.add(place);
                    }
                }
            });
        let shown = Shown {
            walkers,
            firsts: &self.firsts,
            in_srgb: self.in_srgb,
        };
        for (kind, instances) in self.flock.instances().iter_mut().enumerate() {
            let Some(instances) = instances else {
                continue;
            };
            let parts = self.parts.iter().map(|part| &part[kind]);
            let count = parts.clone().map(|part| part.shown.len()).sum();
            let mut bounds = Bounds::default();
            for part in parts {
                bounds.join(&part.bounds);
            }
            shown.write_all((&self.parts, kind), instances.numbers(count));
            instances.upload(count, bounds.aabb());
        }
    }

    /// Removes what was drawn.
    pub(super) fn free(self) {
        self.flock.free();
    }
}

impl Shown<'_> {
    /// Writes the instances of these parts one after the other, on as many threads as there are.
    fn write_all(&self, (parts, kind): (&[[Part; 2]], usize), out: &mut [f32]) {
        if let [part] = parts {
            let out = out.chunks_mut(FETCHED * INSTANCE_NUMBERS);
            for (rows, out) in part[kind].shown.chunks(FETCHED).zip(out) {
                for row in rows {
                    self.walkers.agents()[*row as usize].fetch_shared();
                }
                for (row, out) in rows.iter().zip(out.chunks_exact_mut(INSTANCE_NUMBERS)) {
                    self.write(*row as usize, out);
                }
            }
            return;
        }
        let (first, second) = parts.split_at(parts.len() / 2);
        let count: usize = first.iter().map(|part| part[kind].shown.len()).sum();
        let (left, right) = out.split_at_mut(count * INSTANCE_NUMBERS);
        if !parts.is_empty() {
            rayon::join(
                || self.write_all((first, kind), left),
                || self.write_all((second, kind), right),
            );
        }
    }

    /// Writes a walker on the way from where it was to where it is, in the pose that it had there.
    fn write(&self, row: usize, out: &mut [f32]) {
        let drawn = &self.walkers.drawn()[row];
        let groups = GROUPS as u64;
        let since = (self.walkers.frame() + groups - row as u64 % groups) % groups;
        let share = (since + 1) as f32 / groups as f32;
        let (place, heading) = drawn.at(share);
        let pose = self.walkers.agents()[row].shared_pose((1.0 - share) * drawn.secs);
        let (number, pose) = pose.unwrap_or_default();
        let first = self.firsts.get(number as usize).copied().unwrap_or(0);
        let leaving = if pose.leaving > 0.0 {
            f32::from(pose.beside) + pose.leaving
        } else {
            0.0
        };
        let slot = first + pose.pose as usize;
        let at = (slot, pose.blend, leaving);
        write_instance(place, heading, drawn, at, self.in_srgb, out);
    }
}

fn flock(host: &Gd<Node3D>, mesh: &CrowdMesh, poses: usize, look: &DrawSettings) -> Option<Flock> {
    let node = host.clone().upcast::<Node>();
    Flock::new(&node, mesh, 1, poses, poses, look.material.as_ref())
}
