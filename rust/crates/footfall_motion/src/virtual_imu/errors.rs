//! Errors of a sensor's measurements.

use super::VirtualImuConfig;
use footfall_imu::ImuSample;
use glam::Vec3;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, StandardNormal};

/// Errors of a sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorNoise {
    /// Standard deviation of a sample of specific force, m/s².
    pub force_mps2: f32,
    /// Standard deviation of the constant bias of specific force, m/s².
    pub force_bias_mps2: f32,
    /// Standard deviation of a sample of angular rate, rad/s.
    pub rate_radps: f32,
    /// Standard deviation of the constant bias of angular rate, rad/s.
    pub rate_bias_radps: f32,
    /// Standard deviation of the constant error of an axis' scale, as a share.
    pub scale: f32,
    /// Standard deviation of the constant error of the clock's rate, as a share.
    pub clock: f64,
    /// Share of the samples that are lost.
    pub lost: f32,
    /// Largest specific force that an axis measures, m/s².
    pub most_force_mps2: f32,
    /// Largest angular rate that an axis measures, rad/s.
    pub most_rate_radps: f32,
}

impl SensorNoise {
    /// Noise and biases as in phones and hobby boards, times a factor; scale, clock and range are perfect.
    pub const fn consumer(factor: f32) -> Self {
        Self {
            force_mps2: 0.05 * factor,
            force_bias_mps2: 0.15 * factor,
            rate_radps: 0.005 * factor,
            rate_bias_radps: 0.01 * factor,
            scale: 0.0,
            clock: 0.0,
            lost: 0.0,
            most_force_mps2: f32::INFINITY,
            most_rate_radps: f32::INFINITY,
        }
    }

    /// The same of an uncalibrated board, on a radio link: scales are off by 2 %, the clock by 0.1 %, one sample in fifty is lost, axes end at 4 g and at
    /// 1000 °/s, as such boards are often set. The factor leaves the range alone.
    pub const fn uncalibrated(factor: f32) -> Self {
        Self {
            scale: 0.02 * factor,
            clock: 0.001 * factor as f64,
            lost: 0.02 * factor,
            most_force_mps2: 39.2,
            most_rate_radps: 17.5,
            ..Self::consumer(factor)
        }
    }
}

/// Errors of one sensor, drawn from its seed.
pub(super) struct Errors {
    noise: Option<SensorNoise>,
    random: ChaCha8Rng,
    biases: [Vec3; 2],
    scales: [Vec3; 2],
    clock: f64,
}

impl Errors {
    pub(super) fn new(config: &VirtualImuConfig) -> Self {
        let mut errors = Self {
            noise: config.noise,
            random: ChaCha8Rng::seed_from_u64(config.seed),
            biases: [Vec3::ZERO; 2],
            scales: [Vec3::ONE; 2],
            clock: 1.0,
        };
        if let Some(noise) = config.noise {
            errors.biases = [
                errors.draw() * noise.force_bias_mps2,
                errors.draw() * noise.rate_bias_radps,
            ];
            if noise.scale > 0.0 {
                errors.scales = [(); 2].map(|()| Vec3::ONE + errors.draw() * noise.scale);
            }
            if noise.clock > 0.0 {
                errors.clock += noise.clock * f64::from(errors.draw().x);
            }
        }
        errors
    }

    fn draw(&mut self) -> Vec3 {
        let [x, y, z]: [f32; 3] = core::array::from_fn(|_| StandardNormal.sample(&mut self.random));
        Vec3::new(x, y, z)
    }

    /// Place on the body, up to this distance from the site.
    pub(super) fn place(&mut self, off_m: f32) -> Vec3 {
        let far: f32 = self.random.random();
        // As many places in every part of the ball.
        self.draw().normalize_or_zero() * off_m * far.cbrt()
    }

    /// The sample as the sensor reports it, or `None` if it is lost.
    pub(super) fn add(&mut self, mut sample: ImuSample) -> Option<ImuSample> {
        let Some(noise) = self.noise else {
            return Some(sample);
        };
        let [force_scale, rate_scale] = self.scales;
        sample.time_secs *= self.clock;
        sample.force = sample.force * force_scale + self.biases[0] + self.draw() * noise.force_mps2;
        sample.rate = sample.rate * rate_scale + self.biases[1] + self.draw() * noise.rate_radps;
        let most = [noise.most_force_mps2, noise.most_rate_radps].map(Vec3::splat);
        sample.force = sample.force.clamp(-most[0], most[0]);
        sample.rate = sample.rate.clamp(-most[1], most[1]);
        let lost = noise.lost > 0.0 && self.random.random::<f32>() < noise.lost;
        (!lost).then_some(sample)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use footfall_imu::GRAVITY_MPS2;

    fn errors(noise: SensorNoise, seed: u64) -> Errors {
        Errors::new(&VirtualImuConfig {
            noise: Some(noise),
            seed,
            ..VirtualImuConfig::ideal(100.0)
        })
    }

    fn sample(time_secs: f64, force: Vec3) -> ImuSample {
        ImuSample {
            time_secs,
            force,
            rate: Vec3::ZERO,
        }
    }

    #[test]
    fn an_uncalibrated_board_is_off_by_as_much_as_it_says() {
        let (mut scales, mut clocks, mut kept) = (0.0, 0.0, 0);
        for seed in 0..400 {
            let mut board = errors(SensorNoise::uncalibrated(1.0), seed);
            scales += f64::from((board.scales[0].y - 1.0).powi(2));
            clocks += (board.clock - 1.0).powi(2);
            let samples = (0..50).filter_map(|n| board.add(sample(f64::from(n), Vec3::Y)));
            kept += samples.count();
        }
        let deviation = |squares: f64| (squares / 400.0).sqrt();
        assert!((0.018..0.022).contains(&deviation(scales)));
        assert!((0.0009..0.0011).contains(&deviation(clocks)));
        assert!((0.975..0.985).contains(&(kept as f64 / 20_000.0)));
        let mut board = errors(SensorNoise::uncalibrated(1.0), 3);
        let hit = (0..20).find_map(|_| board.add(sample(0.0, Vec3::new(90.0, -90.0, 0.0))));
        let hit = hit.expect("not all are lost").force;
        assert!(hit.distance(Vec3::new(39.2, -39.2, hit.z)) < 1e-6);
    }

    #[test]
    fn a_consumers_sensor_keeps_time_and_scale() {
        let mut phone = errors(SensorNoise::consumer(1.0), 5);
        let fast = Vec3::Y * 20.0 * GRAVITY_MPS2;
        let reported = phone.add(sample(7.0, fast)).expect("nothing is lost");
        assert!((reported.time_secs - 7.0).abs() < 1e-12 && reported.force.distance(fast) < 1.0);
    }

    #[test]
    fn places_fill_the_ball_around_the_site() {
        let mut errors = errors(SensorNoise::consumer(0.0), 1);
        let places: Vec<Vec3> = (0..1000).map(|_| errors.place(0.05)).collect();
        assert!(places.iter().all(|place| place.length() <= 0.05));
        let outer = places.iter().filter(|place| place.length() > 0.04);
        // 1 - 0.8³ of the volume.
        assert!((420..560).contains(&outer.count()));
    }
}
