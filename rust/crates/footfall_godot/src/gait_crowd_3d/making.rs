//! A crowd made of what its node was given.

use super::behaviour::CrowdBehaviour;
use super::crowd_mesh::CrowdMesh;
use super::{GaitCrowd3D, NO_CHARACTER};
use crate::convert;
use crate::gait_model;
use crate::gait_style;
use crate::report;
use footfall_model::{GaitModel, GaitStyle};
use footfall_rig::crowd::{Crowd, CrowdRecipe, CrowdSettings, Path, Routing};
use footfall_synth::StyleSpace;
use glam::Vec2;
use godot::classes::{Node3D, Path3D};
use godot::prelude::*;
use std::sync::Arc;

/// A model, its styles, and both prepared together if they are in use already.
type CrowdWalk = (Arc<GaitModel>, Vec<Arc<GaitStyle>>, Option<Arc<StyleSpace>>);

impl GaitCrowd3D {
    /// The model, or the add-on's own if none is set.
    pub(super) fn used_model(&self) -> Result<Gd<gait_model::GaitModel>, String> {
        self.fallback.model(self.model.as_ref())
    }

    /// The walk and the styles that walkers are made of.
    fn walk(&self) -> Result<CrowdWalk, String> {
        let model = self.used_model()?;
        let styles = gait_style::trained_all(&self.styles)?;
        let (trained, space) = model.bind().prepared(&styles)?;
        Ok((trained, styles, space))
    }

    pub(super) fn routing(&self) -> Result<Routing, String> {
        match self.behaviour {
            CrowdBehaviour::Scripted => Ok(Routing::Scripted),
            CrowdBehaviour::Navigate => Ok(Routing::Navigate),
            CrowdBehaviour::Wander => Ok(Routing::Wander {
                half: 0.5 * Vec2::new(self.area.x, self.area.y),
            }),
            CrowdBehaviour::Path => {
                let path = self.base().get_node_or_null(&self.path);
                let path = path
                    .and_then(|node| node.try_cast::<Path3D>().ok())
                    .ok_or("Path is not set to a Path3D. Choose one, or another Behaviour.")?;
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
                    .map(Routing::Path)
                    .ok_or_else(|| "The Path3D has no length. Draw its curve.".to_owned())
            }
        }
    }

    /// Creates the crowd if there is none yet; returns whether there is one.
    pub(super) fn make(&mut self) -> bool {
        if self.walkers.is_some() {
            return true;
        }
        if self.problem.is_some() || !self.base().is_inside_tree() {
            return false;
        }
        match self.made() {
            Ok((walkers, mesh)) => {
                self.walkers = Some(walkers);
                self.mesh = Some(mesh);
            }
            Err(problem) => self.fail(&problem),
        }
        self.walkers.is_some()
    }

    /// As [`make`](Self::make), with a row for every added walker.
    pub(super) fn make_whole(&mut self) -> bool {
        let made = self.make();
        if let Some(walkers) = &mut self.walkers {
            walkers.come_in(usize::MAX);
        }
        made
    }

    /// Removes walkers and scene; the next frame makes them again.
    pub(super) fn forget(&mut self) {
        if let Some(scene) = self.scene.take() {
            scene.free();
        }
        self.walkers = None;
        self.replica.renew();
        self.mesh = None;
        self.problem = None;
    }

    /// Removes the crowd and reports the reason; it is not created again until a setting changes.
    pub(super) fn fail(&mut self, problem: &str) {
        self.forget();
        self.problem = Some(problem.to_owned());
        report::warn(&self.base_mut().clone().upcast(), problem);
    }

    /// Problems that keep the crowd from walking, as far as they are known.
    pub(super) fn problems(&self) -> PackedStringArray {
        let mut problems: Vec<String> = Vec::new();
        let checked = self.walk().and_then(|(model, styles, space)| {
            // In use already, and so checked.
            if space.is_some() {
                return Ok(());
            }
            let all: Vec<&GaitStyle> = styles.iter().map(AsRef::as_ref).collect();
            model.check_styles(&all).map_err(|error| error.to_string())
        });
        if let Err(problem) = checked {
            problems.push(problem);
        }
        if self.character.is_none() {
            problems.push(NO_CHARACTER.to_owned());
        }
        if self.behaviour == CrowdBehaviour::Path
            && let Err(problem) = self.routing()
        {
            problems.push(problem);
        }
        if let Some(problem) = &self.problem
            && !problems.contains(problem)
        {
            problems.push(problem.clone());
        }
        problems.iter().map(GString::from).collect()
    }

    fn made(&mut self) -> Result<(Crowd, CrowdMesh), String> {
        let (model, styles, space) = self.walk()?;
        let character = self.character.clone().ok_or(NO_CHARACTER)?;
        let routing = self.routing()?;
        let mut host = self.to_gd().upcast::<Node3D>();
        let mesh = {
            let _released = self.base_mut();
            CrowdMesh::new(&character, &mut host)?
        };
        let tints = self
            .colours
            .as_slice()
            .iter()
            .map(|colour| convert::linear(*colour));
        let settings = CrowdSettings {
            seed: self.seed.cast_unsigned(),
            speeds_mps: [self.speed_range.x, self.speed_range.y],
            sizes: [self.size_range.x, self.size_range.y],
            style_amount: self.style_amount as f32,
            tints: tints.collect(),
            half_area: 0.5 * Vec2::new(self.area.x, self.area.y),
            path_width: self.path_width as f32,
        };
        let recipe = CrowdRecipe {
            model,
            styles,
            space,
            body: mesh.body.clone(),
        };
        let mut walkers = Crowd::new(recipe, routing, settings);
        if self.replica.follows {
            walkers.follow();
        } else {
            walkers.set_count(self.count as usize);
        }
        Ok((walkers, mesh))
    }
}
