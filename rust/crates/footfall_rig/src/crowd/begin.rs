//! Start of walkers: those that other threads have made begin to walk, and change their styles.

use super::Crowd;
use super::maker::Order;
use super::mixtures::StyleMixture;
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

    /// Starts walkers that were made since the last call, a few hundred at most. Returns the style space when it has just been prepared.
    ///
    /// # Errors
    /// [`SynthError`] if the model and the body give no walk.
    pub fn begin_some(&mut self) -> Result<Option<Arc<StyleSpace>>, Arc<SynthError>> {
        self.began.clear();
        self.come_in(MOST_COME_IN);
        let mut come = None;
        if self.mixtures.is_none() {
            let Some(mixtures) = self.maker.mixtures() else {
                return Ok(None);
            };
            let mixtures = mixtures.clone()?;
            come = Some(Arc::clone(&mixtures.space));
            self.mixtures = Some(mixtures);
        }
        self.begin(MOST_BEGIN);
        Ok(come)
    }

    /// Waits until all walkers are made, and starts them.
    ///
    /// # Errors
    /// [`SynthError`] if the model and the body give no walk.
    pub fn begin_all(&mut self) -> Result<Option<Arc<StyleSpace>>, Arc<SynthError>> {
        self.come_in(usize::MAX);
        self.maker.finish();
        let come = self.begin_some()?;
        // Walkers that got another mixture meanwhile change in a second round.
        for _ in 0..2 {
            self.maker.finish();
            self.begin(usize::MAX);
        }
        Ok(come)
    }

    /// Gives a walker a mixture of styles: at once if the mixture is prepared already.
    pub fn wear(&mut self, place: usize, weights: &[f32]) {
        let mixture = StyleMixture::of(&weights[..weights.len().min(self.maker.styles())]);
        let agent = &mut self.agents[place];
        agent.mixture.clone_from(&mixture);
        // A walker that is not made yet gets it when it begins.
        let Some(walker) = agent.own_walker() else {
            return;
        };
        if let Some(styled) = self
            .mixtures
            .as_ref()
            .and_then(|mixtures| mixtures.get(&mixture))
        {
            walker.wear(&styled);
        } else {
            let order = Order {
                place,
                ticket: agent.ticket,
                mixture,
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
                mixture,
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
            if agent.mixture != mixture {
                late.push((place, agent.mixture.weights()));
            }
        });
        for (place, weights) in late {
            self.wear(place, &weights);
        }
    }
}
