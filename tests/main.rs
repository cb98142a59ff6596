//! Physics and numerics, each problem with its source, and the component's interfaces: one program, as each would be linked
//! anew.
#![allow(clippy::unwrap_used)]

mod armature;
mod axial;
mod beam;
mod benchmarks;
mod c;
mod calibration;
mod chatter;
mod check_values;
mod communication;
mod consistency;
mod contact_laws;
mod derivatives;
mod energy_balance;
mod equilibrium;
mod excitation;
mod fixed_spring;
mod fmi_api;
mod friction;
mod imports;
mod many;
mod parallel;
mod preloaded_contact;
mod promise;
mod pusher;
mod refused;
mod resistance;
mod scene_file;
mod second;
mod similarity;
mod spring;
mod stack;
