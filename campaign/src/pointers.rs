//! Pointers to arrays, valid or wrong on purpose.

use std::ptr;

use crate::call::Fault;

/// Two arrays to read and their length.
pub fn arguments<A, B>(fault: Fault, first: &[A], last: &[B]) -> (*const A, *const B, usize) {
    let pointers = (first.as_ptr(), last.as_ptr());
    match fault {
        Fault::FirstNull => (ptr::null(), pointers.1, first.len()),
        Fault::LastNull => (pointers.0, ptr::null(), first.len()),
        Fault::Misaligned => (pointers.0, pointers.1.wrapping_byte_add(1), first.len()),
        Fault::NullAndEndless => (ptr::null(), ptr::null(), usize::MAX),
        Fault::Endless => (pointers.0, pointers.1, usize::MAX),
        _ => (pointers.0, pointers.1, first.len()),
    }
}

/// An array to read, one to write, and their length.
pub fn places<A, B>(fault: Fault, first: &[A], last: &mut [B]) -> (*const A, *mut B, usize) {
    let pointer = last.as_mut_ptr();
    let (first, wrong, count) = arguments(fault, first, last);
    // The address as `arguments` made it, from the pointer that may be written through.
    let moved = wrong.addr().wrapping_sub(pointer.addr());
    let last = if wrong.is_null() { ptr::null_mut() } else { pointer.wrapping_byte_add(moved) };
    (first, last, count)
}

/// The array of orders of a derivative.
pub fn middle(fault: Fault, orders: &[i32]) -> *const i32 {
    match fault {
        Fault::MiddleNull | Fault::NullAndEndless => ptr::null(),
        _ => orders.as_ptr(),
    }
}

/// A single element to write.
pub fn place<T>(fault: Fault, at: &mut T) -> *mut T {
    match fault {
        Fault::LastNull => ptr::null_mut(),
        Fault::Misaligned => ptr::from_mut(at).wrapping_byte_add(1),
        _ => ptr::from_mut(at),
    }
}
