#pragma once

namespace gnomon {

/// sin(x)/x and (1 - cos x)/x^2: up to this x^2, x = 1.25 rad, both are polynomials in x^2 of degree 7: they
/// interpolate at Chebyshev nodes, their constant coefficient being kept exact. With the coefficients rounded
/// to double they are off by at most 1.6e-17 and 8e-18 of the value, so that it is rounding alone that
/// counts.
inline constexpr double sinc_limit = 1.5625;
inline constexpr double sine_coefficients[8] = {1.0,
                                                -0.16666666666666666,
                                                0.008333333333332851,
                                                -0.00019841269840776478,
                                                2.755731903444393e-06,
                                                -2.505207369721675e-08,
                                                1.6055782815851143e-10,
                                                -7.494895594805586e-13};
inline constexpr double versine_coefficients[8] = {0.5,
                                                   -0.041666666666666664,
                                                   0.001388888888888862,
                                                   -2.4801587301312778e-05,
                                                   2.755731911852423e-07,
                                                   -2.0876737688872267e-09,
                                                   1.1468931586384285e-11,
                                                   -4.694801929763846e-14};

}  // namespace gnomon
