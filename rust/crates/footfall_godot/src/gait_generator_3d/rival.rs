//! Generators above this one under the same skeleton: the first one walks.

use super::GaitGenerator3D;
use godot::classes::Skeleton3D;
use godot::prelude::*;

/// Generators above a node, as long as the children stay as they are.
#[derive(Debug, Default)]
pub(super) struct Rivals {
    index: i32,
    children: i32,
    above: Vec<Gd<GaitGenerator3D>>,
}

impl GaitGenerator3D {
    /// Problem when another generator walks the skeleton already.
    pub(super) fn rivalry(&mut self, skeleton: &Gd<Skeleton3D>) -> Option<String> {
        let (index, children) = (self.base().get_index(), skeleton.get_child_count());
        if self.rivals.index != index || self.rivals.children != children {
            self.rivals = Rivals {
                index,
                children,
                above: self.generators_above(skeleton),
            };
        }
        let walks = |rival: &&Gd<Self>| rival.is_instance_valid() && rival.is_active();
        self.rivals.above.iter().find(walks).map(rivalry_message)
    }

    /// As [`rivalry`](Self::rivalry), looked up anew.
    pub(super) fn find_rivalry(&self, skeleton: &Gd<Skeleton3D>) -> Option<String> {
        let above = self.generators_above(skeleton);
        above
            .iter()
            .find(|rival| rival.is_active())
            .map(rivalry_message)
    }

    fn generators_above(&self, skeleton: &Gd<Skeleton3D>) -> Vec<Gd<Self>> {
        let own = self.base().get_index();
        (0..own)
            .filter_map(|index| skeleton.get_child(index)?.try_cast::<Self>().ok())
            .collect()
    }
}

fn rivalry_message(rival: &Gd<GaitGenerator3D>) -> String {
    let name = rival.get_name();
    format!(
        "{name} above this node already walks the same Skeleton3D, so this node does nothing. Remove one of the two, or turn Active off."
    )
}
