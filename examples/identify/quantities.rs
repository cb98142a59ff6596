//! The published results, and the parameters identified from them.

/// A published result used for the identification: Zhang, Zhang, Meng, Ren, Machines 2025, 13(1), 52.
#[derive(Clone, Copy, Debug)]
pub struct Source {
    pub name: &'static str,
    pub unit: &'static str,
    pub place: &'static str,
    /// As printed.
    pub value: f64,
    /// One unit in its last printed digit.
    pub digit: f64,
}

/// The published results, in the order of [`Published::values`].
pub const SOURCES: [Source; 5] = [
    source("static force F_0", "N", "section 3.1", 0.152, 0.001),
    source("contact stiffness k_j", "N/m", "section 3.1", 3.54e6, 0.01e6),
    source("first frequency f_1", "Hz", "section 3.1, Fig. 4", 1354.5, 0.1),
    source("force amplitude at 1000 Hz", "cN", "section 3.2, Fig. 6", 4.812, 0.001),
    source("stiffness coefficient beta", "s", "Table 3", 3.1831e-3, 1e-7),
];

const fn source(name: &'static str, unit: &'static str, place: &'static str, value: f64, digit: f64) -> Source {
    Source {
        name,
        unit,
        place,
        value,
        digit,
    }
}

/// An identified parameter.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    pub symbol: &'static str,
    pub name: &'static str,
    pub unit: &'static str,
    /// The unit in SI units.
    pub scale: f64,
    /// What determines it.
    pub from: &'static str,
}

/// The parameters, in the order of [`Specimen::values`].
#[rustfmt::skip]
pub const PARAMETERS: [Parameter; 7] = [
    parameter("R", "camber radius", "mm", 1e-3, "F_0 and k_j, by the Hertz law"),
    parameter("EI", "bending stiffness", "N mm²", 1e-6, "F_0 at the overtravel of 0.2 mm"),
    parameter("rhoA", "mass per length", "g/m", 1e-3, "f_1, with the rivet mass"),
    parameter("b", "width", "mm", 1e-3, "EI and mass per length, with E = 124 GPa and 8300 kg/m³"),
    parameter("h", "thickness", "mm", 1e-3, "EI and mass per length, with E = 124 GPa and 8300 kg/m³"),
    parameter("m", "rivet mass", "mg", 1e-6, "force amplitude at 1000 Hz, with the mass per length"),
    parameter("beta", "damping times", "µs", 1e-6, "beta over 4 π²"),
];

const fn parameter(
    symbol: &'static str,
    name: &'static str,
    unit: &'static str,
    scale: f64,
    from: &'static str,
) -> Parameter {
    Parameter {
        symbol,
        name,
        unit,
        scale,
        from,
    }
}
