//! A crowd made of what its node was given.

use super::crowd_mesh::CrowdMesh;
use super::walkers::{Settings, Walkers};
use super::way::{Path, Way};
use super::{CrowdBehaviour, GaitCrowd3D, NO_CHARACTER, linear};
use crate::gait_model::{GaitModel, NO_MODEL};
use crate::gait_style;
use crate::walk_source::WalkSource;
use footfall_synth::StyleSpace;
use glam::Vec2;
use godot::classes::{Engine, Node3D, Path3D};
use godot::prelude::*;
use std::sync::Arc;

impl GaitCrowd3D {
    pub(super) fn space(&self, model: &Gd<GaitModel>) -> Result<Arc<StyleSpace>, String> {
        let styles = gait_style::trained_all(&self.styles)?;
        let mut model = model.clone();
        match model.bind_mut().source(&styles)? {
            WalkSource::Styled(space) => Ok(space),
            WalkSource::Switching(_) => Err(
                "A crowd walks with a trained walk (.footfall), not with a switching model: load another Model.".to_owned(),
            ),
        }
    }

    pub(super) fn way(&self) -> Result<Way, String> {
        match self.behaviour {
            CrowdBehaviour::Scripted => Ok(Way::Told),
            CrowdBehaviour::Navigate => Ok(Way::Navigate),
            CrowdBehaviour::Wander => Ok(Way::Wander {
                half: 0.5 * Vec2::new(self.area.x, self.area.y),
            }),
            CrowdBehaviour::Path => {
                let path = self.base().get_node_or_null(&self.path);
                let path = path
                    .and_then(|node| node.try_cast::<Path3D>().ok())
                    .ok_or("Path names no Path3D: choose one, or another Behaviour.")?;
                let points = path
                    .get_curve()
                    .map(|curve| curve.get_baked_points())
                    .unwrap_or_default();
                let to_crowd = self.base().get_global_transform().affine_inverse()
                    * path.get_global_transform();
                let points = points.as_slice().iter().map(|point| {
                    let place = to_crowd * *point;
                    Vec2::new(place.x, place.z)
                });
                Path::new(points.collect())
                    .map(Way::Path)
                    .ok_or_else(|| "The Path3D has no length: draw its curve.".to_owned())
            }
        }
    }

    /// Makes the walkers if there are none yet; whether there are.
    pub(super) fn make(&mut self) -> bool {
        if self.walkers.is_some() {
            return true;
        }
        if self.failed || !self.base().is_inside_tree() {
            return false;
        }
        match self.made() {
            Ok(walkers) => self.walkers = Some(walkers),
            Err(problem) => {
                self.failed = true;
                if !Engine::singleton().is_editor_hint() {
                    let node = self.base().get_path();
                    godot_warn!("{node}: {problem}");
                }
            }
        }
        self.walkers.is_some()
    }

    fn made(&mut self) -> Result<Walkers, String> {
        let model = self.model.clone().ok_or(NO_MODEL)?;
        let character = self.character.clone().ok_or(NO_CHARACTER)?;
        let space = self.space(&model)?;
        let way = self.way()?;
        let mut host = self.to_gd().upcast::<Node3D>();
        let mesh = {
            let _released = self.base_mut();
            CrowdMesh::new(&character, &mut host)?
        };
        let tints = self.colours.as_slice().iter().map(|colour| linear(*colour));
        let settings = Settings {
            seed: self.seed.cast_unsigned(),
            speeds_mps: [self.speed_range.x, self.speed_range.y],
            sizes: [self.size_range.x, self.size_range.y],
            style_amount: self.style_amount as f32,
            tints: tints.collect(),
            half_area: 0.5 * Vec2::new(self.area.x, self.area.y),
            path_width: self.path_width as f32,
        };
        let mut walkers = Walkers::new(&space, mesh, way, settings)?;
        walkers.populate(self.count as usize);
        Ok(walkers)
    }
}
