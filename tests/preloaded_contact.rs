//! A mass pressed on a contact by a constant force, shaken by a sine or by white noise.
//!
//! The problem of the literature on vibrating Hertzian contacts: P. R. Nayak, J. Sound Vib. 22 (1972) 297; J. Perret-Liaudet
//! and E. Rigaud, J. Sound Vib. 265 (2003) 289 and 309; Q. Ma, A. Kahraman, J. Perret-Liaudet and E. Rigaud,
//! doi:10.1115/1.2190230. For a force that follows any power p, in units of preload, stiffness at preload and mass:
//!
//! `y'' + 2 z y' + g(y, y') - 1 = s cos(w t)`, `g = max(0, u^p + 2 z_c u^(p - 1) y')` where `u = 1 + y/p > 0`, else 0
//!
//! The digits are of methods that integrate nothing in time: a balance of 240 harmonics, each evaluated at 8192 samples of a
//! period; the quadrature `T = 2 int dy / v(y)` of the free motion; and under white noise the stationary solution of the
//! Fokker-Planck equation, a density proportional to `exp(-(v^2/2 + V(y)) / heat)`.

use std::f64::consts::TAU;

use relay_contact::inputs::Inputs;
use relay_contact::reference::{Generator, Law, Mode, Preload};
use relay_contact::simulation::Simulation;
use relay_contact::variables::RealOutput;
use testing::rig::{Rig, compose};
use testing::scenes::{accelerated, shaken};

/// Preload of the specimen (N), its stiffness there (N/m) and a mass of the order of its rivet (kg).
const FORCE: f64 = 0.152;
const STIFFNESS: f64 = 3.54e6;
const MASS: f64 = 50e-6;

const TOLERANCE: f64 = 1e-9;

/// Units of time and length.
fn units() -> (f64, f64) {
    ((MASS / STIFFNESS).sqrt(), FORCE / STIFFNESS)
}

/// Exponents of the force: of spheres, and of a stiffness that grows with the force to the power 0.54.
const HERTZ: f64 = 1.5;
const ROUGH: f64 = 1.0 / (1.0 - 0.54);

/// The mass at rest on the contact, with the damping ratios of the mass and of the contact, under a sine of this frequency,
/// level and phase.
fn rig(exponent: f64, ratios: [f64; 2], [frequency, level, phase]: [f64; 3]) -> Rig {
    let (time, length) = units();
    let mut scene = shaken(level * FORCE / MASS, frequency / (TAU * time));
    scene.excitation.phase = phase;
    let mode = Mode {
        omega_squared: 0.0,
        damping: 2.0 * ratios[0] / time,
        tip: 1.0 / MASS.sqrt(),
        participation: MASS.sqrt(),
        ..Mode::default()
    };
    let coefficient = FORCE * (exponent * length).powf(-exponent);
    let law = Law::power(coefficient, exponent, 2.0 * ratios[1] * time);
    Rig::new(compose(&[mode], law, 0.0, TOLERANCE, FORCE).with(|model| {
        model.preload = Preload {
            force: FORCE,
            indentation: exponent * length,
            contact_stiffness: STIFFNESS,
            ..Preload::default()
        };
        model.generator = Generator::new(&scene);
    }))
}

/// Sets the rate of the indentation, in units.
fn launch(rig: &mut Rig, rate: f64) {
    let (time, length) = units();
    rig.launch(&[-rate * length / time * MASS.sqrt()]);
}

/// A steady motion: ratios of damping of mass and contact, frequency, level, periods of the sine in one of the motion; from
/// the balance: phase of the sine and rate where the deviation passes zero upwards, its mean, its amplitude at the
/// frequency of the sine, and the share of the time in which the contact is open.
struct Steady(f64, f64, f64, f64, f64, [f64; 2], [f64; 3]);

#[rustfmt::skip]
const STEADY_HERTZ: [Steady; 8] = [
    Steady(0.05, 0.0, 0.9, 0.05, 1.0, [0.475_620_752, 0.216_366_910], [-0.004_813_3, 0.239_929_5, 0.0]),
    Steady(0.05, 0.0, 0.9, 0.3, 1.0, [2.750_867_053, 2.095_378_756], [-0.603_053_6, 2.182_631_2, 0.388_126_7]),
    Steady(0.0, 0.05, 0.9, 0.3, 1.0, [2.923_425_377, 2.196_152_162], [-0.633_617_7, 2.229_074_2, 0.418_950_2]),
    Steady(0.05, 0.0, 0.7, 0.4, 1.0, [2.849_619_970, 3.321_407_789], [-2.170_746_2, 4.131_009_0, 0.601_169_4]),
    Steady(0.0, 0.05, 0.7, 0.4, 1.0, [3.271_287_499, 3.597_919_698], [-2.367_203_8, 4.359_627_8, 0.627_623_6]),
    Steady(0.05, 0.0, 1.02, 0.45, 1.0, [2.979_111_559, 1.852_182_015], [-0.356_381_2, 1.759_565_9, 0.279_450_7]),
    // Close to the superharmonic resonance of order 2, and a subharmonic of order 2.
    Steady(0.05, 0.0, 0.5, 0.7, 1.0, [0.436_659_874, 1.142_007_414], [-0.112_744_8, 0.917_131_9, 0.0]),
    Steady(0.02, 0.0, 1.8, 0.6, 2.0, [1.654_624_253, 1.804_486_397], [-0.437_262_1, 0.371_801_7, 0.338_962_1]),
];

#[rustfmt::skip]
const STEADY_ROUGH: [Steady; 8] = [
    Steady(0.05, 0.0, 0.9, 0.05, 1.0, [0.495_713_388, 0.217_527_894], [-0.007_846_4, 0.240_875_3, 0.0]),
    Steady(0.05, 0.0, 0.9, 0.3, 1.0, [2.801_450_859, 2.131_845_403], [-0.759_127_2, 2.218_791_0, 0.285_282_8]),
    Steady(0.0, 0.05, 0.9, 0.3, 1.0, [2.947_091_797, 2.246_360_853], [-0.788_706_3, 2.260_196_3, 0.331_876_3]),
    Steady(0.05, 0.0, 0.7, 0.4, 1.0, [2.881_713_298, 3.390_583_917], [-2.520_251_4, 4.177_449_6, 0.580_582_6]),
    Steady(0.0, 0.05, 0.7, 0.4, 1.0, [3.263_390_667, 3.700_531_842], [-2.717_657_5, 4.396_721_4, 0.615_945_7]),
    Steady(0.05, 0.0, 1.02, 0.45, 1.0, [3.042_959_968, 1.856_011_124], [-0.462_062_8, 1.768_933_1, 0.0]),
    Steady(0.05, 0.0, 0.5, 0.7, 1.0, [0.608_949_920, 1.341_973_995], [-0.204_126_8, 0.847_301_5, 0.0]),
    Steady(0.02, 0.0, 1.8, 0.6, 2.0, [1.908_092_071, 1.942_601_164], [-0.607_118_1, 0.410_999_6, 0.119_581_9]),
];

/// The balance is right to its last digit; with damping in the contact, whose force has a kink, only to 2e-6: half of the
/// harmonics move it by 1.2e-6. The component's error is of the order of its tolerance over the damping ratio.
fn steady(exponent: f64, motions: &[Steady]) {
    const SAMPLES: u32 = 512;
    let (time, length) = units();
    for Steady(z, z_c, frequency, level, periods, [phase, rate], expected) in motions {
        let mut rig = rig(exponent, [*z, *z_c], [*frequency, *level, *phase]);
        launch(&mut rig, *rate);
        let period = periods * TAU * time / frequency;
        // A motion that is not stable would have left by now.
        let start = 60.0 * period;
        rig.run_to(&Inputs::default(), start).unwrap();
        let [mut mean, mut cosine, mut sine] = [0.0; 3];
        for k in 1..=SAMPLES {
            let part = f64::from(k) / f64::from(SAMPLES);
            rig.run_to(&Inputs::default(), start + part * period).unwrap();
            let y = rig.state.contact().approach / length / f64::from(SAMPLES);
            let (s, c) = (periods * TAU * part).sin_cos();
            (mean, cosine, sine) = (mean + y, cosine + 2.0 * y * c, sine + 2.0 * y * s);
        }
        let last = rig.state.contact().last_closing.zip(rig.state.contact().last_opening);
        let open = if let Some((closing, opening)) = last.filter(|(_, opening)| *opening > start) {
            ((closing - opening) / period).rem_euclid(1.0)
        } else {
            0.0
        };
        let allowed = if *z_c > 0.0 { 2e-6 } else { 2e-7 };
        for (found, expected) in [mean, f64::hypot(cosine, sine), open].into_iter().zip(expected) {
            let error = (found - expected).abs();
            assert!(error < allowed, "{z} {z_c} {frequency} {level}: {found} against {expected}");
        }
    }
}

#[test]
fn steady_motions_are_those_of_the_harmonic_balance() {
    steady(HERTZ, &STEADY_HERTZ);
    steady(ROUGH, &STEADY_ROUGH);
}

/// Frequency, the level up to which a motion that grew from a weak excitation keeps contact, and of the motion there phase of
/// the sine and rate where the deviation passes zero upwards.
#[rustfmt::skip]
const LEVELS_HERTZ: [[f64; 4]; 5] = [
    [0.5, 0.859_970_88, 0.555_159_013, 1.436_730_868],
    [0.95, 0.132_832_28, 1.689_559_852, 1.346_210_648],
    [1.0, 0.187_823_78, 2.486_095_331, 1.402_837_631],
    [1.1, 0.440_460_93, 2.956_610_980, 1.520_931_377],
    [1.5, 1.821_384_30, 3.177_080_263, 2.020_803_062],
];

/// The balance is right to 2e-6 here, as it finds the lowest of 2048 samples of a period.
#[test]
fn contact_is_lost_at_the_level_of_the_harmonic_balance() {
    for [frequency, level, phase, rate] in LEVELS_HERTZ {
        for (factor, opens) in [(1.0 - 1e-5, false), (1.0 + 1e-5, true)] {
            let mut rig = rig(HERTZ, [0.05, 0.0], [frequency, factor * level, phase]);
            launch(&mut rig, rate);
            let start = 60.0 * TAU * units().0 / frequency;
            rig.run_to(&Inputs::default(), start).unwrap();
            rig.run_to(&Inputs::default(), 1.1 * start).unwrap();
            assert_eq!(rig.state.contact().last_opening > Some(start), opens, "{frequency} {factor}");
        }
    }
}

/// Rate of the free motion as it passes the preload, and its period. In the third it just keeps contact.
const FREE_HERTZ: [[f64; 2]; 5] = [
    [0.134_164_078_6, 6.285_285_134],
    [0.670_820_393_2, 6.339_293_980],
    [1.341_640_785_8, 6.592_372_103],
    [1.897_366_596_1, 7.302_589_482],
    [4.242_640_687_1, 11.417_113_694],
];

const FREE_ROUGH: [[f64; 2]; 5] = [
    [0.172_567_756_9, 6.288_377_661],
    [0.862_838_784_7, 6.422_177_627],
    [1.725_677_568_5, 7.007_611_039],
    [2.440_476_622_8, 8.032_996_108],
    [5.457_071_626_1, 13.388_879_146],
];

/// After a hundred periods the deviation is zero again. The digits given leave 5e-8 of a time unit there; the integrator's
/// error in the period is of the order of the tolerance, because energy is kept.
fn free(exponent: f64, motions: &[[f64; 2]]) {
    let (time, length) = units();
    for &[rate, period] in motions {
        let mut rig = rig(exponent, [0.0, 0.0], [1.0, 0.0, 0.0]);
        launch(&mut rig, rate);
        rig.run_to(&Inputs::default(), 100.0 * period * time).unwrap();
        let late = rig.state.contact().approach / length / rate;
        assert!(late.abs() < 1e-6 * rate.max(1.0), "{rate}: {late:e} after a hundred periods");
    }
}

#[test]
fn the_period_of_the_free_motion_grows_with_its_energy() {
    free(HERTZ, &FREE_HERTZ);
    free(ROUGH, &FREE_ROUGH);
}

/// Variance of the rate under white noise, and what follows from it: standard deviation of the force, share of the time in
/// which the contact is open, and losses of contact per unit of time.
const NOISE_HERTZ: [(f64, [f64; 3]); 2] =
    [(0.5, [0.676_496, 0.045_261, 0.025_536]), (1.0, [0.909_326, 0.150_297, 0.059_960])];

const NOISE_ROUGH: [(f64, [f64; 3]); 2] =
    [(0.5, [0.682_131, 0.013_880, 0.007_831]), (1.0, [0.930_239, 0.083_385, 0.033_266])];

/// White noise, held for a fortieth of a period, so that its density at the resonance is lower by 0.2 %. The means of a
/// hundred stretches tell the standard error, of which a tolerance of 1e-3 makes less than a tenth. The mean force is the preload,
/// whatever the noise.
fn noise(exponent: f64, levels: &[(f64, [f64; 3])]) {
    const STRETCHES: u32 = 100;
    const STEPS: u32 = 6000;
    const RATIO: f64 = 0.1;
    let (time, _) = units();
    let step = TAU / 40.0;
    for (heat, expected) in levels {
        let rig = rig(exponent, [RATIO, 0.0], [1.0, 0.0, 0.0]);
        let model = rig.model.with(|model| model.scene.solver.tolerance = 1e-3);
        let mut simulation = Simulation::from_state(model, &rig.state);
        let mut random = fastrand::Rng::with_seed(8);
        let mut normal = || (-2.0 * (1.0 - random.f64()).ln()).sqrt() * (TAU * random.f64()).cos();
        let size = (4.0 * RATIO * heat / step).sqrt() * FORCE / MASS;
        let mut found = Vec::new();
        for _ in 0..STRETCHES {
            let [mut mean, mut square, mut open, mut losses] = [0.0; 4];
            for _ in 0..STEPS {
                let before = simulation.real(RealOutput::ContactLastOpening);
                simulation.step(&accelerated(size * normal(), 0.0), simulation.time(), step * time).unwrap();
                let force = simulation.real(RealOutput::ContactForce) / FORCE;
                mean += force;
                square += (force - 1.0).powi(2);
                open += f64::from(u8::from(force == 0.0));
                losses += f64::from(u8::from(simulation.real(RealOutput::ContactLastOpening) > before)) / step;
            }
            found.push([mean, square, open, losses].map(|sum| sum / f64::from(STEPS)));
        }
        let exact = [1.0, expected[0].powi(2), expected[1], expected[2]];
        for (k, exact) in exact.into_iter().enumerate() {
            let count = f64::from(STRETCHES);
            let mean = found.iter().map(|each| each[k]).sum::<f64>() / count;
            let squares: f64 = found.iter().map(|each| (each[k] - mean).powi(2)).sum();
            let error = (squares / (count * (count - 1.0))).sqrt();
            let deviation = (mean - exact).abs();
            assert!(deviation < 4.0 * error + 0.002 * exact, "{heat} {k}: {mean} +- {error} against {exact}");
            assert!(error < 0.08 * exact, "{heat} {k}: {mean} +- {error}");
        }
    }
}

#[test]
fn under_white_noise_the_force_has_the_stationary_distribution() {
    noise(HERTZ, &NOISE_HERTZ);
    noise(ROUGH, &NOISE_ROUGH);
}

/// A motion of just the energy `p^2 / (p + 1)` (in preload force times length unit) at which an undamped contact touches the
/// point of no force: soft contacts part there so gradually that rounding decides. It costs no more steps than others, and
/// keeps its energy to what a few hundred errors of the tolerance make.
#[test]
fn grazing_contacts_do_not_stall() {
    let (time, length) = units();
    for exponent in [HERTZ, ROUGH, 3.0, 10.0] {
        for above in [-1e-3, -1e-7, 0.0, 1e-7, 1e-3] {
            let energy = exponent * exponent / (exponent + 1.0) * (1.0 + above);
            let mut rig = rig(exponent, [0.0; 2], [1.0, 0.0, 0.0]);
            launch(&mut rig, (2.0 * energy).sqrt());
            let before = rig.energy();
            rig.run_to(&Inputs::default(), 40.0 * TAU * time).unwrap();
            let lost = (rig.energy() - before).abs() / (FORCE * length * energy);
            assert!(lost < 1e-6, "p = {exponent}, {above}: {lost}");
            assert!(rig.state.steps < 10_000, "p = {exponent}, {above}: {}", rig.state.steps);
        }
    }
}
