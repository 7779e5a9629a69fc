//! Half floats: 16 bits (IEEE 754).

/// The value of a half float, from its bits.
pub fn value_of_half(bits: u16) -> f32 {
    let (sign, exponent, fraction) = (u32::from(bits >> 15) << 31, u32::from(bits >> 10 & 31), u32::from(bits & 1023));
    match exponent {
        // A subnormal is its fraction times 2^-24.
        0 => f32::from_bits((fraction as f32 * f32::from_bits(103 << 23)).to_bits() | sign),
        31 => f32::from_bits(sign | 255 << 23 | fraction << 13),
        _ => f32::from_bits(sign | (exponent + 112) << 23 | fraction << 13),
    }
}

/// The bits of the half float that is nearest to a value, of two the even one; what is too large becomes the largest.
pub fn half_of_value(value: f32) -> u16 {
    /// The largest half float, and the smallest that is not subnormal.
    const LARGEST: f32 = 65504.0;
    const NORMAL: f32 = 6.103_515_6e-5;
    let (sign, size) = ((value.to_bits() >> 16) as u16 & 0x8000, value.abs());
    if size < NORMAL {
        return sign | (size * (1 << 24) as f32).round_ties_even() as u16;
    }
    let bits = size.min(LARGEST).to_bits();
    sign | ((bits + 0xfff + (bits >> 13 & 1) - (112 << 23)) >> 13) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_what_ieee_says() {
        for (bits, value) in [
            (0, 0.0),
            (0x3c00, 1.0),
            (0x7bff, 65504.0),
            (0x0400, 6.103_515_6e-5),
            (0x03ff, 6.097_555e-5),
            (0xc000, -2.0),
        ] {
            assert_eq!(value_of_half(bits), value, "{bits:x}");
        }
        assert!(value_of_half(0x7c00).is_infinite() && value_of_half(0x7e00).is_nan());
        assert!(value_of_half(0x8000).is_sign_negative());
    }

    #[test]
    fn halves_are_the_nearest_and_of_two_the_even() {
        let finite = (0..=u16::MAX).filter(|bits| bits & 0x7c00 != 0x7c00);
        assert!(finite.clone().all(|bits| half_of_value(value_of_half(bits)) == bits));
        for bits in finite.filter(|bits| bits & 0x7fff < 0x7bff) {
            let middle = (value_of_half(bits) + value_of_half(bits + 1)) / 2.0;
            assert_eq!(half_of_value(middle), bits + (bits & 1), "{bits:x}");
        }
        assert_eq!([half_of_value(1e9), half_of_value(-f32::INFINITY)], [0x7bff, 0xfbff]);
    }
}
