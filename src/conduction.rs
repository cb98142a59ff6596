//! What the circuits conduct at a communication point: that of the contact with its parallel one, and that of the second contact.

use crate::electrical::ElectricalContact;
use crate::integrator::motion::Motion;
use crate::link::CONTACT;
use crate::model::Model;
use crate::variables::RealOutput;

struct Conducting<'a> {
    electrical: &'a ElectricalContact,
    /// Its contact, and one parallel to it, each with its own law.
    contacts: [Option<(usize, &'a ElectricalContact)>; 2],
    /// Conductance of the spot of each, S.
    spots: [f64; 2],
    /// All of it, S.
    conductance: f64,
}

impl<'a> Conducting<'a> {
    /// The circuit of a contact; `None` without the contact or a resistance.
    #[inline(always)]
    fn of(model: &'a Model, motion: &Motion, role: Option<usize>) -> Option<Self> {
        let law = |index: usize| Some((index, model.links.get(index)?.electrical.as_ref()?));
        let own = law(role?)?;
        let parallel = model.roles.parallel.filter(|_| role == Some(CONTACT));
        let contacts = [Some(own), parallel.and_then(law)];
        let spot = |(index, law): (usize, &ElectricalContact)| law.spot(motion.force(model, index));
        let spots = contacts.map(|contact| contact.map_or(0.0, spot));
        let (_, electrical) = own;
        Some(Self { electrical, contacts, spots, conductance: electrical.beside(spots.iter().sum()) })
    }

    /// Rates of the conductances of both spots, S/s.
    fn rates(&self, model: &Model, motion: &Motion) -> [f64; 2] {
        self.contacts.map(|contact| {
            contact.map_or(0.0, |(index, law)| {
                law.conductance_slope(motion.force(model, index)) * motion.link_rates(model, index).0
            })
        })
    }

    /// Share of the current through its contact, 1.
    fn share(&self) -> f64 {
        let [own, other] = self.spots;
        if other == 0.0 { 1.0 } else { own / (own + other) }
    }

    /// The rate of that at these rates of both conductances (S/s), 1/s.
    fn share_rate(&self, [own_rate, other_rate]: [f64; 2]) -> f64 {
        let [own, other] = self.spots;
        if other == 0.0 {
            return 0.0;
        }
        (own_rate * other - own * other_rate) / (own + other).powi(2)
    }
}

/// The contact of the circuit that an output is of.
fn role(model: &Model, output: RealOutput) -> Option<usize> {
    match output {
        RealOutput::SecondConductance | RealOutput::SecondResistance => model.roles.second,
        _ => Some(CONTACT),
    }
}

/// A real output of the circuits, in its SI unit.
pub(crate) fn output(model: &Model, motion: &Motion, output: RealOutput) -> f64 {
    let scene = &model.scene;
    let Some(circuit) = Conducting::of(model, motion, role(model, output)) else {
        let warm = output == RealOutput::ContactTemperature;
        return if warm { scene.environment.temperature } else { 0.0 };
    };
    let (electrical, conductance) = (circuit.electrical, circuit.conductance);
    match output {
        RealOutput::ContactConductance | RealOutput::SecondConductance => conductance,
        RealOutput::ContactResistance | RealOutput::SecondResistance => 1.0 / conductance,
        RealOutput::ContactVoltage => {
            let highest = scene.contact.open_voltage;
            (motion.current / conductance).clamp(-highest, highest)
        }
        RealOutput::ContactTemperature if scene.effects.heating => {
            let force = motion.force(model, CONTACT);
            electrical.temperature(scene, force, motion.current * circuit.share())
        }
        RealOutput::ContactTemperature => scene.environment.temperature,
        _ => 0.0,
    }
}

/// Greatest resistance of the circuit of the contact within the last communication step, Ohm; 0 without a resistance, or if extremes
/// are not requested.
pub(crate) fn greatest_resistance(model: &Model, motion: &Motion) -> f64 {
    let electrical = model.links.get(CONTACT).and_then(|link| link.electrical);
    let Some(electrical) = electrical.filter(|_| model.scene.effects.extremes) else { return 0.0 };
    let mut extremes = motion.extremes(model);
    1.0 / match model.roles.parallel {
        Some(_) => electrical.beside(extremes.pair),
        None => electrical.conductance(extremes.of(CONTACT).least),
    }
}

/// Rate of a continuous output of the circuits, in its SI unit per second.
pub(crate) fn rate(model: &Model, motion: &Motion, output: RealOutput) -> f64 {
    let Some(circuit) = Conducting::of(model, motion, role(model, output)) else { return 0.0 };
    let rates = circuit.rates(model, motion);
    let (conductance, rate) = (circuit.conductance, rates.iter().sum::<f64>());
    match output {
        RealOutput::ContactConductance | RealOutput::SecondConductance => rate,
        RealOutput::ContactResistance | RealOutput::SecondResistance => -rate / conductance.powi(2),
        RealOutput::ContactVoltage => {
            let voltage = motion.current / conductance;
            if voltage.abs() >= model.scene.contact.open_voltage {
                return 0.0;
            }
            (motion.current_rate - voltage * rate) / conductance
        }
        RealOutput::ContactTemperature if model.scene.effects.heating => {
            let (share, share_rate) = (circuit.share(), circuit.share_rate(rates));
            let (force, current) = (motion.force(model, CONTACT), motion.current * share);
            let current_rate = motion.current_rate * share + motion.current * share_rate;
            let (by_force, by_current) = circuit.electrical.temperature_slopes(&model.scene, force, current);
            let force_rate = motion.link_rates(model, CONTACT).0;
            by_force * force_rate + by_current * current.signum() * current_rate
        }
        _ => 0.0,
    }
}
