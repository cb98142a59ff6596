//! The floating-point environment of a call. Hosts run with traps on, with another rounding, or flush small numbers to
//! zero; compiled Rust assumes none of this. So each function runs in the default environment, and the host finds its
//! own again at the end. Finding out costs about a nanosecond; control words are written only where they differ.

/// Runs `body` in the default floating-point environment.
#[inline]
pub(super) fn with_default<R>(body: impl FnOnce() -> R) -> R {
    let host = control::read();
    let differs = !control::is_default(host);
    if differs {
        control::write(control::DEFAULT);
    }
    let result = body();
    if differs {
        control::write(host);
    }
    result
}

/// SSE for arithmetic; x87, which mathematical functions of C libraries use on Windows.
#[cfg(target_arch = "x86_64")]
mod control {
    use std::arch::asm;

    /// MXCSR and the control word of the x87.
    pub(super) type Words = (u32, u16);

    /// Exceptions masked, rounding to nearest, no flushing to zero.
    pub(super) const DEFAULT: Words = (0x1f80, 0x037f);

    /// Bits of MXCSR that tell which exceptions have occurred.
    const OCCURRED: u32 = 0x3f;
    /// Bits of the control word for exceptions and rounding; the precision is left out.
    const X87: u16 = 0x0c3f;

    #[inline]
    pub(super) fn read() -> Words {
        let (mut sse, mut x87) = DEFAULT;
        // SAFETY: each instruction writes the one variable that it is given.
        unsafe {
            asm!("stmxcsr [{}]", "fnstcw [{}]", in(reg) &raw mut sse, in(reg) &raw mut x87, options(nostack, preserves_flags));
        }
        (sse, x87)
    }

    #[inline]
    pub(super) fn is_default((sse, x87): Words) -> bool {
        sse & !OCCURRED == DEFAULT.0 && x87 & X87 == DEFAULT.1 & X87
    }

    /// Clears the exceptions of the x87, which would otherwise raise the first trap that is turned on.
    #[cold]
    pub(super) fn write((sse, x87): Words) {
        // SAFETY: the words are the default or were read before, so no reserved bit is set.
        unsafe {
            asm!("fnclex", "ldmxcsr [{}]", "fldcw [{}]", in(reg) &raw const sse, in(reg) &raw const x87, options(nostack, preserves_flags));
        }
    }
}

#[cfg(target_arch = "aarch64")]
mod control {
    use std::arch::asm;

    /// FPCR.
    pub(super) type Words = u64;

    /// No traps, rounding to nearest, no flushing to zero.
    pub(super) const DEFAULT: Words = 0;

    #[inline]
    pub(super) fn read() -> Words {
        let word;
        // SAFETY: reads a register.
        unsafe { asm!("mrs {}, fpcr", out(reg) word, options(nostack, preserves_flags)) }
        word
    }

    #[inline]
    pub(super) fn is_default(word: Words) -> bool {
        word == DEFAULT
    }

    #[cold]
    pub(super) fn write(word: Words) {
        // SAFETY: the word is the default or was read before.
        unsafe { asm!("msr fpcr, {}", in(reg) word, options(nostack, preserves_flags)) }
    }
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod control {
    pub(super) type Words = ();
    pub(super) const DEFAULT: Words = ();
    pub(super) fn read() -> Words {}
    pub(super) fn is_default((): Words) -> bool {
        true
    }
    pub(super) fn write((): Words) {}
}
