//! Sine and friends, the same to the last bit on every platform.
//!
//! `f64::sin` calls the platform's C library natively and another one in wasm; they may differ in
//! the last digit. Everything here goes through the crate `libm`. `sqrt` is exact by IEEE 754 and
//! needs no helper.

/// Sine and cosine of an angle in radians.
pub fn sin_cos(angle: f64) -> (f64, f64) {
    libm::sincos(angle)
}

/// Tangent of an angle in radians.
pub fn tan(angle: f64) -> f64 {
    libm::tan(angle)
}

/// Angle of the vector (x, y), radians in (-pi, pi].
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Angle whose cosine is `x`, radians in [0, pi].
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}
