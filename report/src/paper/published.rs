//! Published values: Zhang, Zhang, Meng, Ren, Machines 2025, 13(1), 52.

/// Base acceleration of the excitation grid, m/s2 (Table 3).
pub const ACCELERATION: f64 = 98.0;
/// Frequencies of the grid, Hz (Table 3).
pub const FREQUENCIES: [f64; 8] = [250.0, 500.0, 750.0, 1000.0, 1250.0, 1500.0, 1750.0, 2000.0];
/// Damping ratios at 1000 Hz (Table 3).
pub const RATIOS: [f64; 6] = [0.1, 1.0, 5.0, 10.0, 20.0, 30.0];
/// Their stiffness coefficients beta, as printed (Table 3).
pub const BETAS: [f64; 6] = [3.1831e-5, 3.1831e-4, 1.5916e-3, 3.1831e-3, 6.3662e-3, 9.5493e-3];
/// The ratio whose results come closest to the measurements.
pub const BEST: f64 = 10.0;

/// Static force, N, and contact stiffness, N/m (section 3.1).
pub const FORCE: f64 = 0.152;
pub const STIFFNESS: f64 = 3.54e6;

/// First frequency without and with prestress at 15.5 mm and 0.2 mm, Hz (section 3.1).
pub const WITHOUT_PRESTRESS: f64 = 1397.6;
pub const WITH_PRESTRESS: f64 = 1354.5;
/// First frequencies with prestress of shorter springs: length and overtravel, mm, and frequency, Hz (section 3.1).
pub const SHORT: [(f64, f64, f64); 3] = [(11.5, 0.45, 2777.2), (11.5, 0.5, 2652.3), (7.5, 0.25, 4426.0)];
/// Free lengths of the modal analyses, mm (Table 2).
pub const LENGTHS: [f64; 3] = [7.5, 11.5, 15.5];

/// Force amplitude, cN, displacement amplitude, um, and that over the excitation's, at 1000 Hz with the ratio 10 (section 3.2,
/// Fig. 6).
pub const FORCE_AMPLITUDE: f64 = 4.812;
pub const DISPLACEMENT: f64 = 3.115;
pub const DISPLACEMENT_RATIO: f64 = 1.256;
/// Between force and displacement at 1000 Hz, degrees (section 3.2).
pub const PHASE: f64 = 90.0;
/// Peaks of the force amplitude in the time domain: ratio, Hz, cN (section 3.2, Fig. 7).
pub const PEAKS: [(f64, f64, f64); 3] = [(10.0, 1250.0, 5.2), (20.0, 750.0, 3.3), (30.0, 250.0, 3.1)];
/// Displacement amplitude over the excitation's, less 1, at 1250 Hz: ratio, % (section 3.2, Fig. 8).
pub const DISPLACEMENT_DEVIATIONS: [(f64, f64); 2] = [(10.0, 65.5), (30.0, 11.4)];
/// Displacement amplitudes at 1000 Hz, um, in the order of [`RATIOS`] (Table 4).
pub const DISPLACEMENTS: [f64; 6] = [6.485, 4.547, 3.773, 3.115, 2.632, 2.524];
/// Measured at 1000 Hz, um (section 4.2, Fig. 14).
pub const MEASURED_DISPLACEMENT: f64 = 2.9;

/// Mass coefficients of the frequency domain, 1/s (section 3.2, Fig. 9).
pub const ALPHAS: [f64; 5] = [3000.0, 4000.0, 5000.0, 6000.0, 7000.0];
/// Peaks there: mass coefficient, Hz, cN (section 3.2, Fig. 9).
pub const FREQUENCY_DOMAIN_PEAKS: [(f64, f64, f64); 2] = [(3000.0, 1300.0, 8.7), (7000.0, 1100.0, 4.2)];
/// The mass coefficients that go with the ratios 10, 20, 30, 1/s, and the largest deviation between the domains as stated
/// (section 4.2, Fig. 19).
pub const EQUIVALENT: [(f64, f64, Option<&str>); 3] = [
    (10.0, 5125.0, None),
    (20.0, 10_250.0, Some("within 8 %")),
    (30.0, 15_375.0, Some("within 8 %")),
];
/// Mass coefficient over stiffness coefficient, 1/s2 (eq. 33).
pub const ALPHA_PER_BETA: f64 = 1_610_065.0;

/// Resistance over force: mOhm at 1 N, and the exponent (eq. 29).
pub const RESISTANCE: (f64, f64) = (7.4118, 0.9515);
/// Height of the roughness, m (section 3.3).
pub const ROUGHNESS: f64 = 12.84e-6;
/// Measured resistance at 1000 Hz, mOhm (section 4.2, Fig. 16).
pub const MEASURED_RESISTANCE: (f64, f64) = (25.0, 63.0);
/// Deviations of the least and greatest resistance from the measured ones: ratio, %, % (Table 6).
pub const RESISTANCE_DEVIATIONS: [(f64, f64, f64); 3] =
    [(10.0, 30.23, 1.89), (20.0, 41.63, 16.18), (30.0, 53.69, 24.85)];
/// Samples of the resistance per second (Table 5).
pub const RESISTANCE_SAMPLING: f64 = 15_625.0;
/// Deviation of the greatest resistance at 1000 Hz with a mass coefficient of 5125 1/s, % (section 4.2). The measured
/// resistances at other frequencies, whose deviations are stated too, are not published.
pub const FREQUENCY_DOMAIN_DEVIATION: f64 = 1.21;
