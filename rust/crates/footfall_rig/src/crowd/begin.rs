//! Walkers begin to walk, and dress, as they are made.

use super::Crowd;
use super::kit::Outfit;
use super::maker::Order;
use footfall_synth::{Detail, StyleSpace, SynthError};
use std::sync::Arc;

/// Walkers that begin in one frame at most.
const MOST_BEGIN: usize = 256;
/// Walkers that get their rows in one frame at most.
const MOST_COME_IN: usize = 256;

impl Crowd {
    /// Returns whether walkers are still being made.
    pub fn is_making(&self) -> bool {
        self.maker.is_busy() || self.are_coming()
    }

    /// Lets those begin who were made meanwhile, a few hundred at most; returns what they are made with when that has just come.
    ///
    /// # Errors
    /// [`SynthError`] when nobody can walk.
    pub fn begin_some(&mut self) -> Result<Option<Arc<StyleSpace>>, Arc<SynthError>> {
        self.began.clear();
        self.come_in(MOST_COME_IN);
        let mut come = None;
        if self.kit.is_none() {
            let Some(kit) = self.maker.kit() else {
                return Ok(None);
            };
            let kit = kit.clone()?;
            come = Some(Arc::clone(&kit.space));
            self.kit = Some(kit);
        }
        self.begin(MOST_BEGIN);
        Ok(come)
    }

    /// Waits until everybody is made, and lets them begin.
    ///
    /// # Errors
    /// [`SynthError`] when nobody can walk.
    pub fn begin_all(&mut self) -> Result<Option<Arc<StyleSpace>>, Arc<SynthError>> {
        self.come_in(usize::MAX);
        self.maker.finish();
        let come = self.begin_some()?;
        // Who was given another outfit meanwhile is dressed in a second round.
        for _ in 0..2 {
            self.maker.finish();
            self.begin(usize::MAX);
        }
        Ok(come)
    }

    /// Lets a walker wear a mixture of styles, at once where others wear it already.
    pub fn wear(&mut self, place: usize, weights: &[f32]) {
        let outfit = Outfit::of(&weights[..weights.len().min(self.maker.styles())]);
        let agent = &mut self.agents[place];
        agent.outfit.clone_from(&outfit);
        // Who is not made yet is dressed when it comes.
        let Some(walker) = agent.own_walker() else {
            return;
        };
        if let Some(styled) = self.kit.as_ref().and_then(|kit| kit.known(&outfit)) {
            walker.wear(&styled);
        } else {
            let order = Order {
                place,
                ticket: agent.ticket,
                outfit,
                config: None,
                alone: false,
            };
            self.maker.take(core::iter::once(order));
        }
    }

    fn begin(&mut self, most: usize) {
        let Self {
            maker,
            agents,
            roster,
            began,
            seen,
            stirs,
            time_secs,
            ..
        } = self;
        let mut late = Vec::new();
        maker.hand_out(most, |made| {
            let Order {
                place,
                ticket,
                outfit,
                ..
            } = made.order;
            let Some(agent) = agents.get_mut(place).filter(|agent| agent.ticket == ticket) else {
                return;
            };
            if let Some(mut walker) = made.walker {
                walker.set_detail(Detail::Quarter);
                agent.begin(walker, *time_secs);
                if agent.is_made() {
                    seen[place] = agent.seen();
                    stirs[place].steps = agent.steps();
                }
                began.push(roster.name(place));
            } else if let Some(walker) = agent.own_walker() {
                walker.wear(&made.styled);
            }
            if agent.outfit != outfit {
                late.push((place, agent.outfit.weights()));
            }
        });
        for (place, weights) in late {
            self.wear(place, &weights);
        }
    }
}
