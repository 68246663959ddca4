//! One linear system as it runs: f32, laid out for the loop that runs it.

use footfall_model::Regime;

/// A system, ready to run from any of its starts.
#[derive(Debug)]
pub(super) struct RunningSystem {
    order: usize,
    channels: usize,
    /// Transition and output matrix in one, column by column: what a number of the state adds to the next state and to the outputs.
    columns: Vec<f32>,
    /// Drift, then output offset.
    offsets: Vec<f32>,
    /// The states in which segments begin, one after the other.
    starts: Vec<f32>,
    /// The first two frames of outputs from each start.
    begins: Vec<f32>,
    /// Room for a state and what follows from it.
    state: Vec<f32>,
    next: Vec<f32>,
    /// Room for what the outputs jump by at the switch, and how fast that changes a frame.
    jump: Vec<[f32; 2]>,
}

/// The nearest few, nearest first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest<const N: usize> {
    found: [(f32, usize); N],
    len: usize,
}

impl<const N: usize> Nearest<N> {
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Squared distance of the nearest.
    pub(super) fn distance(&self) -> f32 {
        self.found[0].0
    }

    pub(super) fn get(&self, rank: usize) -> usize {
        self.found[rank].1
    }

    fn offer(&mut self, distance: f32, start: usize) {
        let rank = self.found[..self.len].partition_point(|(nearer, _)| *nearer <= distance);
        if rank == N {
            return;
        }
        self.len = (self.len + 1).min(N);
        self.found[rank..self.len].rotate_right(1);
        self.found[rank] = (distance, start);
    }
}

impl RunningSystem {
    pub(super) fn new(regime: &Regime) -> Self {
        let system = &regime.system;
        let (order, channels) = (system.order(), system.channels());
        let mut columns = Vec::with_capacity(order * (order + channels));
        for column in 0..order {
            let (transition, output) = (&system.transition, &system.output);
            columns.extend(transition.column(column).iter().map(|value| *value as f32));
            columns.extend(output.column(column).iter().map(|value| *value as f32));
        }
        let offsets = system.drift.iter().chain(system.offset.iter());
        let mut running = Self {
            order,
            channels,
            columns,
            offsets: offsets.map(|value| *value as f32).collect(),
            starts: regime
                .starts
                .iter()
                .flatten()
                .map(|value| *value as f32)
                .collect(),
            begins: Vec::new(),
            state: vec![0.0; order],
            next: vec![0.0; order + channels],
            jump: vec![[0.0; 2]; channels],
        };
        let mut begins = Vec::new();
        let mut outputs = Vec::with_capacity(2 * channels);
        for start in 0..regime.starts.len() {
            running.run(start, 2, &[], 1.0, &mut outputs);
            begins.extend_from_slice(&outputs);
        }
        running.begins = begins;
        running
    }

    /// The starts whose outputs, and the way they go, are nearest to two expected frames; all alike when there are none.
    pub(super) fn nearest<const N: usize>(&self, expected: &[f32]) -> Nearest<N> {
        let mut nearest = Nearest {
            found: [(f32::INFINITY, 0); N],
            len: 0,
        };
        for (start, begins) in self.begins.chunks_exact(2 * self.channels).enumerate() {
            let pairs = begins.iter().zip(expected);
            let distance: f32 = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
            nearest.offer(distance, start);
        }
        nearest
    }

    /// Puts out `frames` frames from a start into `weights`. They go on from two `expected` frames: what lies between dies away,
    /// critically damped with a time constant of `settle` frames.
    pub(super) fn run(
        &mut self,
        start: usize,
        frames: usize,
        expected: &[f32],
        settle: f32,
        weights: &mut Vec<f32>,
    ) {
        let (order, channels) = (self.order, self.channels);
        self.state
            .copy_from_slice(&self.starts[start * order..][..order]);
        self.jump.fill([0.0; 2]);
        if let (Some(begins), [_, ..]) = (self.begins.get(start * 2 * channels..), expected) {
            for (channel, jump) in self.jump.iter_mut().enumerate() {
                let gap = |frame: usize| {
                    expected[frame * channels + channel] - begins[frame * channels + channel]
                };
                *jump = [gap(0), gap(1) - gap(0) + gap(0) / settle];
            }
        }
        let decay = (-1.0 / settle).exp();
        let mut remains = 1.0;
        weights.clear();
        for frame in 0..frames {
            self.next.copy_from_slice(&self.offsets);
            let columns = self.columns.chunks_exact(order + channels);
            for (value, column) in self.state.iter().zip(columns) {
                for (next, column) in self.next.iter_mut().zip(column) {
                    *next += value * column;
                }
            }
            let (state, outputs) = self.next.split_at(order);
            self.state.copy_from_slice(state);
            let pairs = outputs.iter().zip(&self.jump);
            let frame = frame as f32;
            weights.extend(
                pairs.map(|(output, [gap, slope])| output + remains * (gap + slope * frame)),
            );
            remains *= decay;
        }
    }
}
