//! Random numbers that depend on nothing but what they are for: pcg4d of Jarzynski and Olano 2020, "Hash Functions for GPU
//! Rendering". The same call gives the same number on every machine, in any order, and on the GPU.

/// Four mixed numbers of 32 bits.
#[inline]
pub fn pcg4d(v: [u32; 4]) -> [u32; 4] {
    pcg4d_lanes(v.map(|n| [n])).map(|[n]| n)
}

/// The same for many at once: each of the four numbers has as many lanes.
#[inline(always)]
pub fn pcg4d_lanes<const N: usize>(mut v: [[u32; N]; 4]) -> [[u32; N]; 4] {
    v.as_flattened_mut().iter_mut().for_each(|n| *n = n.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    mix(&mut v);
    v.as_flattened_mut().iter_mut().for_each(|n| *n ^= *n >> 16);
    mix(&mut v);
    v
}

/// 24 of the bits as a number in [0, 1).
#[inline]
pub fn unit(bits: u32) -> f64 {
    f64::from(bits >> 8) / f64::from(1_u32 << 24)
}

#[inline(always)]
fn mix<const N: usize>([x, y, z, w]: &mut [[u32; N]; 4]) {
    for k in 0..N {
        x[k] = x[k].wrapping_add(y[k].wrapping_mul(w[k]));
        y[k] = y[k].wrapping_add(z[k].wrapping_mul(x[k]));
        z[k] = z[k].wrapping_add(x[k].wrapping_mul(y[k]));
        w[k] = w[k].wrapping_add(y[k].wrapping_mul(z[k]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_the_published_one() {
        assert_eq!(pcg4d([7, 5, 16, 1]), [1_994_569_773, 3_797_644_551, 1_317_212_266, 398_917_715]);
        let other = [3_181_487_890, 2_050_621_626, 3_130_977_103, 2_379_543_595];
        assert_eq!(pcg4d([1234, 1, 5, 2_853_113_487]), other);
    }
}
