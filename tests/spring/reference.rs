//! Exact frequencies of a stepped beam: the solution of each uniform stretch in closed form, carried from the clamp to the
//! end over masses and supports (transfer matrices: W. C. Pestel, F. A. Leckie, Matrix Methods in Elastomechanics, 1963).

/// A uniform stretch, and what sits at its end.
#[derive(Clone, Copy)]
pub struct Stretch {
    pub length: f64,
    pub bending_stiffness: f64,
    pub mass_per_length: f64,
    /// Mass and rotary inertia at its end.
    pub mass: f64,
    pub inertia: f64,
    /// Elastic support at its end, N/m.
    pub support: f64,
    /// The same against rotation, N m.
    pub turn: f64,
}

/// Deflection, slope, moment and shear.
type State = [f64; 4];

impl Stretch {
    pub fn uniform(length: f64, bending_stiffness: f64, mass_per_length: f64) -> Self {
        Self { length, bending_stiffness, mass_per_length, mass: 0.0, inertia: 0.0, support: 0.0, turn: 0.0 }
    }

    /// The state at the end from that at the start: `E I w'''' = rho A omega^2 w`, `M = E I w''`, `V = E I w'''`.
    fn carry(&self, [w, slope, moment, shear]: State, omega: f64) -> State {
        let k = (self.mass_per_length * omega * omega / self.bending_stiffness).sqrt().sqrt();
        let x = k * self.length;
        // Krylov's functions: each the derivative of the next, over k.
        let (sin, cos, sinh, cosh) = (x.sin(), x.cos(), x.sinh(), x.cosh());
        let s = [f64::midpoint(cosh, cos), f64::midpoint(sinh, sin), (cosh - cos) / 2.0, (sinh - sin) / 2.0];
        let start =
            [w, slope / k, moment / (self.bending_stiffness * k * k), shear / (self.bending_stiffness * k.powi(3))];
        let derivative = |order: usize| -> f64 { (0..4).map(|n| start[n] * s[(n + 4 - order) % 4]).sum() };
        let [w, slope, moment, shear] = [0, 1, 2, 3].map(derivative);
        let (slope, moment, shear) =
            (k * slope, self.bending_stiffness * k * k * moment, self.bending_stiffness * k.powi(3) * shear);
        // What sits there: its inertia and support are forces and moments on the spring.
        let force = (self.mass * omega * omega - self.support) * w;
        let turned = (self.turn - self.inertia * omega * omega) * slope;
        [w, slope, moment + turned, shear + force]
    }
}

/// The determinant whose zeros are the frequencies, for a clamp of this rotational stiffness (infinite: rigid).
fn determinant(stretches: &[Stretch], clamp: f64, omega: f64) -> f64 {
    // Motions that the clamp allows: a rotation with its moment, and a shear.
    let turned = if clamp.is_finite() { [0.0, 1.0, clamp, 0.0] } else { [0.0, 0.0, 1.0, 0.0] };
    let carry = |start: State| stretches.iter().fold(start, |state, stretch| stretch.carry(state, omega));
    let ([.., m1, v1], [.., m2, v2]) = (carry(turned), carry([0.0, 0.0, 0.0, 1.0]));
    m1 * v2 - m2 * v1
}

/// The first `count` angular frequencies, found from sign changes on a grid of `step` (rad/s).
pub fn frequencies(stretches: &[Stretch], clamp: f64, step: f64, count: usize) -> Vec<f64> {
    let f = |omega: f64| determinant(stretches, clamp, omega);
    (1..)
        .map(|n| (f64::from(n) * step, f64::from(n + 1) * step))
        .filter_map(|(a, b)| relay_contact::reference::bracketed(f, a, b))
        .take(count)
        .collect()
}
