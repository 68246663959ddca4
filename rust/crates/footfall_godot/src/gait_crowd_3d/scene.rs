//! Visible part of a crowd.

use super::actors::Actors;
use super::crowd_mesh::CrowdMesh;
use super::flock::{Flock, POSE_BYTES, write_pose};
use super::instances::{draws_in_srgb, write_instance};
use super::shared_flock::SharedFlock;
use super::sizes::{Sizes, eyesight};
use crate::convert;
use footfall_core::{JOINT_COUNT, Joint};
use footfall_rig::crowd::{Crowd, FETCHED, GROUPS, Limits, Tier};
use footfall_synth::CrowdPose;
use glam::{Vec3, Vec4};
use godot::classes::{Node, Node3D, PackedScene, ShaderMaterial};
use godot::prelude::*;
use rayon::prelude::*;

/// Number of frames after which tiers are chosen again.
const CHOOSE_EVERY: u64 = 8;
/// Margin around the camera's view in which walkers count as seen, metres: poses must be there before they are needed.
const MARGIN_M: f32 = 3.0;

/// Settings of a crowd's look.
pub(super) struct DrawSettings {
    pub(super) character: Option<Gd<PackedScene>>,
    pub(super) material: Option<Gd<ShaderMaterial>>,
    pub(super) culls: bool,
    /// Height on screen below which a stand-in shows a walker, pixels.
    pub(super) stand_in_px: f32,
    /// Whole scenes that are made in one frame at most, and flocks that get more room: each takes the engine a millisecond or more.
    pub(super) most_made: usize,
}

/// Drawing of a crowd.
pub(super) struct CrowdScene {
    mesh: CrowdMesh,
    near: Flock,
    far: Vec<Flock>,
    shared: SharedFlock,
    actors: Actors,
    /// Frames that were drawn.
    drawn: u64,
    /// The crowd's frame that was drawn last.
    frame: u64,
    /// The sides of what the camera sees, kept for its memory.
    planes: Vec<Vec4>,
    /// The walkers in each instance of a flock: those with the character's mesh, and those with its stand-in.
    shown: [Vec<u32>; 2],
    sizes: Sizes,
    /// When each walker's pose among those far away was written last, counted in frames.
    ticks: Vec<u64>,
    /// Groups of those far away of whom no poses are written yet.
    unwritten: [bool; GROUPS],
    /// True when walkers are waiting for a whole scene.
    lacking: bool,
    /// True where instances have their colours in sRGB.
    in_srgb: bool,
}

impl CrowdScene {
    /// Without room for anybody yet.
    pub(super) fn new(host: &Gd<Node3D>, mesh: CrowdMesh, look: &DrawSettings) -> Option<Self> {
        Some(Self {
            near: near(host, &mesh, 1, look)?,
            far: (0..GROUPS)
                .map(|_| far(host, &mesh, 1, look))
                .collect::<Option<Vec<_>>>()?,
            shared: SharedFlock::new(host, &mesh, look)?,
            actors: Actors::default(),
            mesh,
            drawn: 0,
            frame: 0,
            planes: Vec::new(),
            shown: [Vec::new(), Vec::new()],
            sizes: Sizes::default(),
            ticks: Vec::new(),
            unwritten: [true; GROUPS],
            lacking: false,
            in_srgb: draws_in_srgb(),
        })
    }

    /// Makes space for all walkers; for many new ones at once, within some frames.
    fn fit(&mut self, host: &Gd<Node3D>, walkers: &Crowd, limits: &Limits, look: &DrawSettings) {
        let (room, each) = rooms(walkers, limits);
        let places = walkers.agents().len();
        for shown in &mut self.shown {
            shown.reserve(room.saturating_sub(shown.len()));
        }
        self.ticks.resize(places, 0);
        let mut left = look.most_made;
        if room > self.near.room
            && let Some(made) = near(host, &self.mesh, room, look)
        {
            core::mem::replace(&mut self.near, made).free();
            left -= 1;
        }
        for (group, flock) in self.far.iter_mut().enumerate() {
            // Half as much again, so that it seldom happens.
            if left > 0
                && each > flock.room
                && let Some(made) = far(host, &self.mesh, each.max(flock.room * 3 / 2), look)
            {
                core::mem::replace(flock, made).free();
                left -= 1;
                self.unwritten[group] = true;
                // It holds no pose yet.
                for tick in self.ticks.iter_mut().skip(group).step_by(GROUPS) {
                    *tick = 0;
                }
            }
        }
    }

    /// Forgets those who had these places.
    pub(super) fn leave(&mut self, places: &[usize]) {
        for place in places {
            self.actors.take_back(*place);
            if let Some(tick) = self.ticks.get_mut(*place) {
                *tick = 0;
            }
        }
    }

    /// The whole scenes.
    pub(super) fn actors(&self) -> &Actors {
        &self.actors
    }

    /// Draws all walkers.
    pub(super) fn draw(
        &mut self,
        walkers: &mut Crowd,
        host: &Gd<Node3D>,
        limits: &Limits,
        look: &DrawSettings,
    ) {
        self.drawn += 1;
        self.fit(host, walkers, limits, look);
        if !walkers.began().is_empty() && self.frame == walkers.frame() {
            // While time stands still no group is due.
            self.unwritten = [true; GROUPS];
        }
        self.frame = walkers.frame();
        let camera = host
            .get_viewport()
            .and_then(|viewport| viewport.get_camera_3d());
        if self.drawn % CHOOSE_EVERY == 1 {
            let place = camera.as_ref().map_or(Vec3::ZERO, |camera| {
                convert::vec3(host.to_local(camera.get_global_position()))
            });
            walkers.choose_tiers(place, limits);
            self.lend(walkers, host, look);
        } else if self.lacking {
            self.lend(walkers, host, look);
        }
        // Only the crowd's own shader shows the colours of stand-ins.
        let stand_in = self.mesh.stand_in.as_ref();
        let view = stand_in
            .filter(|_| look.material.is_none())
            .and_then(|mesh| eyesight(camera.as_ref()?, host, mesh.height_m, look.stand_in_px));
        self.sizes.look(walkers, view.as_ref());
        let mut planes = core::mem::take(&mut self.planes);
        planes.clear();
        if let Some(camera) = camera.filter(|_| look.culls) {
            add_planes(&camera, host, &mut planes);
        }
        self.draw_near(walkers, &planes);
        self.draw_far(walkers, &planes);
        let small = self.sizes.small();
        self.shared
            .draw(walkers, (&planes, small), (host, &self.mesh, look));
        self.planes = planes;
        self.actors.pose(walkers.agents());
    }

    /// Removes what was drawn.
    pub(super) fn free(mut self) {
        self.actors.clear();
        self.near.free();
        self.shared.free();
        for flock in self.far {
            flock.free();
        }
    }

    fn lend(&mut self, walkers: &Crowd, host: &Gd<Node3D>, look: &DrawSettings) {
        if let Some(character) = &look.character {
            let mut host = host.clone();
            self.lacking = self.actors.lend(
                walkers.tiers(),
                walkers.agents(),
                character,
                &mut host,
                look.most_made,
            );
        }
    }

    /// Draws walkers with a new pose in every frame, and those for which there was no scene.
    fn draw_near(&mut self, walkers: &Crowd, planes: &[Vec4]) {
        let (agents, tiers, drawn) = (walkers.agents(), walkers.tiers(), walkers.drawn());
        for shown in &mut self.shown {
            shown.clear();
        }
        let mut left = self.near.poses().len() / POSE_BYTES;
        let small = self.sizes.small();
        for (index, (drawn, tier)) in drawn.iter().zip(tiers).enumerate() {
            let index = index as u32;
            let wanted = match tier {
                Tier::Full => !self.actors.plays(index),
                Tier::Near => true,
                // Until nothing is left of the steps of its own.
                Tier::Far => walkers.repeats && walkers.is_alone(index as usize),
            };
            if wanted && left > 0 && is_seen(drawn.places[1], planes) {
                self.shown[usize::from(small[index as usize])].push(index);
                left -= 1;
            }
        }
        let [whole, stand_ins] = &self.shown;
        let first = whole.len() * POSE_BYTES;
        let turned_by = &self.mesh.turned_by;
        let in_srgb = self.in_srgb;
        let (of_whole, of_stand_ins) = self.near.poses().split_at_mut(first);
        for (out, shown) in [(of_whole, whole), (of_stand_ins, stand_ins)] {
            out.par_chunks_mut(FETCHED * POSE_BYTES)
                .zip(shown.par_chunks(FETCHED))
                .with_min_len(8)
                .for_each(|(out, shown)| {
                    for index in shown {
                        agents[*index as usize].fetch_pose();
                    }
                    let mut pose = CrowdPose::default();
                    for (out, index) in out.chunks_exact_mut(POSE_BYTES).zip(shown) {
                        agents[*index as usize].pose(&mut pose);
                        write_pose(&pose, turned_by, out);
                    }
                });
        }
        if !whole.is_empty() || !stand_ins.is_empty() {
            self.near.upload_poses();
        }
        self.near.show([whole, stand_ins], |slot, row, out| {
            let drawn = &drawn[row as usize];
            let (place, heading) = drawn.at(1.0);
            write_instance(place, heading, drawn, (slot, 0.0, 0.0), in_srgb, out);
            place
        });
    }

    /// Draws distant walkers: the group that has just moved gets its previous and its new poses, and is drawn between
    /// the two.
    fn draw_far(&mut self, walkers: &Crowd, planes: &[Vec4]) {
        let (tiers, drawn) = (walkers.tiers(), walkers.drawn());
        let frame = walkers.frame();
        let turned_by = &self.mesh.turned_by;
        let (small, in_srgb) = (self.sizes.small(), self.in_srgb);
        for (group, flock) in self.far.iter_mut().enumerate() {
            let since = (frame + GROUPS as u64 - group as u64) % GROUPS as u64;
            // At first all are, so that a crowd whose time stands still is seen.
            let unwritten = core::mem::take(&mut self.unwritten[group]);
            if since == 0 || unwritten {
                write_far(flock, group, walkers, turned_by, planes, &self.ticks);
                for index in (group..drawn.len()).step_by(GROUPS).take(flock.room) {
                    if is_far(walkers, index, planes) {
                        self.ticks[index] = frame;
                    }
                }
                flock.upload_poses();
            }
            let share = (since + 1) as f32 / GROUPS as f32;
            for shown in &mut self.shown {
                shown.clear();
            }
            for index in (group..drawn.len()).step_by(GROUPS).take(flock.room) {
                let is_far = tiers[index] == Tier::Far && walkers.is_alone(index);
                if is_far && frame - self.ticks[index] < GROUPS as u64 {
                    self.shown[usize::from(small[index])].push(index as u32);
                }
            }
            let [whole, stand_ins] = &self.shown;
            flock.show([whole, stand_ins], |_, row, out| {
                let drawn = &drawn[row as usize];
                let (place, heading) = drawn.at(share);
                let at = (2 * (row as usize / GROUPS), share, 0.0);
                write_instance(place, heading, drawn, at, in_srgb, out);
                place
            });
        }
    }
}

/// Writes the two poses of every walker of a group that is far away and seen: where it was, and where it is.
fn write_far(
    flock: &mut Flock,
    group: usize,
    walkers: &Crowd,
    turned_by: &[Joint; JOINT_COUNT],
    planes: &[Vec4],
    ticks: &[u64],
) {
    let (agents, frame) = (walkers.agents(), walkers.frame());
    let (poses, last) = flock.poses_and_last();
    poses
        .par_chunks_mut(2 * POSE_BYTES)
        .zip(last.par_chunks(2 * POSE_BYTES))
        .enumerate()
        .with_min_len(64)
        .for_each(|(slot, (out, last))| {
            let index = group + slot * GROUPS;
            let Some(agent) = agents.get(index) else {
                return;
            };
            if !is_far(walkers, index, planes) {
                return;
            }
            let mut pose = CrowdPose::default();
            let (was, is) = out.split_at_mut(POSE_BYTES);
            agent.pose(&mut pose);
            write_pose(&pose, turned_by, is);
            if frame - ticks[index] == GROUPS as u64 {
                was.copy_from_slice(&last[POSE_BYTES..]);
            } else {
                was.copy_from_slice(is);
            }
        });
}

/// Returns whether a walker is there, far away, in steps of its own, and seen.
fn is_far(walkers: &Crowd, index: usize, planes: &[Vec4]) -> bool {
    walkers.tiers()[index] == Tier::Far
        && walkers.is_alone(index)
        && !walkers.repeats
        && is_seen(walkers.drawn()[index].places[1], planes)
}

/// Room for walkers whose pose is new in every frame, and for each group of those far away.
fn rooms(walkers: &Crowd, limits: &Limits) -> (usize, usize) {
    let places = walkers.agents().len();
    // All of them may go away at once, and others come.
    let near = places.min(2 * (limits.counts[0] + limits.counts[1]));
    let far = if walkers.repeats {
        0
    } else {
        places.div_ceil(GROUPS)
    };
    (near.max(1), far.max(1))
}

fn near(host: &Gd<Node3D>, mesh: &CrowdMesh, room: usize, look: &DrawSettings) -> Option<Flock> {
    let node = host.clone().upcast::<Node>();
    Flock::new(&node, mesh, 0, room, room, look.material.as_ref())
}

fn far(host: &Gd<Node3D>, mesh: &CrowdMesh, room: usize, look: &DrawSettings) -> Option<Flock> {
    let node = host.clone().upcast::<Node>();
    Flock::new(&node, mesh, 1, room, 2 * room, look.material.as_ref())
}

/// The planes around what a camera sees, in the crowd's space: normals outwards, and distances.
fn add_planes(camera: &Gd<godot::classes::Camera3D>, host: &Gd<Node3D>, planes: &mut Vec<Vec4>) {
    let world = convert::frame(host.get_global_transform());
    let sides = camera.get_frustum();
    planes.extend(sides.iter_shared().map(|plane| {
        let normal = convert::vec3(plane.normal);
        let local = world.rotation.conjugate() * normal;
        local.extend(plane.d - normal.dot(world.position))
    }));
}

pub(super) fn is_seen(place: Vec3, planes: &[Vec4]) -> bool {
    let middle = place + Vec3::Y * 0.9;
    planes
        .iter()
        .all(|plane| plane.truncate().dot(middle) - plane.w < MARGIN_M)
}
