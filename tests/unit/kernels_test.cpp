#include "accel/kernels/kernels.h"

#include <gtest/gtest.h>

using rayengine::kernels::Vec3;

TEST(Kernels, RootsOfAUnitSphereSeenFromFarAway) {
  Vec3<double> p, o{0.25, 0, -1e7}, d{0, 0, 1};
  double s, a, b, c, near, far;
  rayengine::kernels::approach(o, d, p, s);
  rayengine::kernels::diagonal_coefficients(1., 1., 1., 0., -1., p, d, a, b, c);
  rayengine::kernels::roots(a, b, c, near, far);
  EXPECT_NEAR(s + near, 1e7 - std::sqrt(1 - 0.0625), 1e-8);
  EXPECT_NEAR(s + far, 1e7 + std::sqrt(1 - 0.0625), 1e-8);
}

TEST(Kernels, LanesGiveTheBitsOfScalars) {
  typedef double lanes __attribute__((vector_size(16)));
  Vec3<lanes> o{lanes{0.1, 0.2}, lanes{} + 0.1, lanes{} - 5}, d{lanes{}, lanes{} + 0.01, lanes{} + 1}, p;
  lanes s, a, b, c, near, far;
  rayengine::kernels::approach(o, d, p, s);
  rayengine::kernels::diagonal_coefficients(lanes{} + 1, lanes{} + 1, lanes{} - 1, lanes{}, lanes{}, p, d, a, b, c);
  rayengine::kernels::roots(a, b, c, near, far);
  for (int i = 0; i < 2; ++i) {
    Vec3<double> p1;
    double s1, a1, b1, c1, near1, far1;
    rayengine::kernels::approach(Vec3<double>{o.x[i], o.y[i], o.z[i]}, Vec3<double>{d.x[i], d.y[i], d.z[i]}, p1, s1);
    rayengine::kernels::diagonal_coefficients(1., 1., -1., 0., 0., p1, Vec3<double>{d.x[i], d.y[i], d.z[i]}, a1, b1,
                                              c1);
    rayengine::kernels::roots(a1, b1, c1, near1, far1);
    EXPECT_EQ(near[i], near1);
    EXPECT_EQ(far[i], far1);
  }
}

TEST(Kernels, HighlightsAreThoseOfExactPowersUpToWhatNobodySees) {
  const Vec3<float> up{0, 0, 1};
  for (const float shininess : {1.f, 19.f, 404.f, 1e5f})
    for (int i = 0; i <= 1000; ++i) {
      const double angle = 3.1 * i / 1000;  // between the light and the eye, which looks from straight above
      const Vec3<float> to_light{static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))};
      const double half = std::atan2(to_light.x, 1.0 + to_light.z);
      const double exact = std::pow(std::cos(half), static_cast<double>(shininess));
      const float got = rayengine::kernels::highlight(shininess, up, to_light, up);
      EXPECT_NEAR(got, exact, 2e-14 + 2e-7 * shininess * exact) << shininess << " at " << angle;
    }
}
