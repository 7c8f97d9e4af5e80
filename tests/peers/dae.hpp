// The four problems of dae.cpp, in the coordinates that suit a solver of differential-algebraic equations best.
#pragma once
#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <string>
#include <vector>

using Vector = std::vector<double>;

/// LU factors of a small dense matrix, by rows.
template <typename T>
struct Factors {
  int n = 0;
  std::vector<T> a;
  std::vector<int> pivots;

  void factor(std::vector<T> matrix) {
    a = std::move(matrix);
    n = static_cast<int>(std::lround(std::sqrt(double(a.size()))));
    pivots.resize(n);
    for (int k = 0; k < n; ++k) {
      int p = k;
      for (int i = k + 1; i < n; ++i)
        if (std::abs(a[i * n + k]) > std::abs(a[p * n + k])) p = i;
      pivots[k] = p;
      if (a[p * n + k] == T(0)) throw std::runtime_error("a singular matrix");
      if (p != k) std::swap_ranges(&a[k * n], &a[k * n] + n, &a[p * n]);
      for (int i = k + 1; i < n; ++i) {
        const T factor = a[i * n + k] /= a[k * n + k];
        if (factor == T(0)) continue;
        for (int j = k + 1; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
      }
    }
  }

  void solve(T *b) const {
    for (int k = 0; k < n; ++k) std::swap(b[k], b[pivots[k]]);
    for (int i = 1; i < n; ++i)
      for (int j = 0; j < i; ++j) b[i] -= a[i * n + j] * b[j];
    for (int i = n - 1; i >= 0; --i) {
      for (int j = i + 1; j < n; ++j) b[i] -= a[i * n + j] * b[j];
      b[i] /= a[i * n + i];
    }
  }
};

/// M(q) q̈ + Gᵀ λ = f, g(t, q) = 0, at one state.
struct Terms {
  Vector mass, force, violation, jacobian, rate, gamma;
  Terms(int n, int m) : mass(n * n), force(n), violation(m), jacobian(m * n), rate(m), gamma(m) {}
};

/// A problem: either y' = F(t, y), or with m constraints on n coordinates, y = (q, q̇).
struct Problem {
  int n, m;
  double end;
  Vector start;
  Problem(int n, int m, double end, Vector start) : n(n), m(m), end(end), start(std::move(start)) {}
  virtual ~Problem() = default;
  /// F(t, y), where there are no constraints.
  virtual void rate(double, const double *, double *) const {}
  /// M, f, g, G, ∂g/∂t, and γ in G q̈ = γ, where there are some.
  virtual void terms(double, const double *, const double *, Terms &) const {}
  /// What is compared.
  virtual Vector points(const double *y) const = 0;
};

/// The heavy top: unit quaternion and angular velocity in the body, about the fixed point.
struct Top : Problem {
  double height = 0.2, radius = 0.15, gravity = 9.81;
  double across = radius * radius / 4 + height * height, axial = radius * radius / 2;
  Top() : Problem(7, 0, 5, {std::cos(M_PI / 6), std::sin(M_PI / 6), 0, 0, 0, 0, 60}) {}
  void rate(double, const double *y, double *out) const override {
    const double a = y[0], b = y[1], c = y[2], d = y[3], p = y[4], q = y[5], r = y[6];
    const double stretch = 1 - a * a - b * b - c * c - d * d;  // draws the quaternion back to length one
    out[0] = 0.5 * (-b * p - c * q - d * r) + stretch * a;
    out[1] = 0.5 * (a * p + c * r - d * q) + stretch * b;
    out[2] = 0.5 * (a * q + d * p - b * r) + stretch * c;
    out[3] = 0.5 * (a * r + b * q - c * p) + stretch * d;
    const double ux = 2 * (b * d - a * c), uy = 2 * (c * d + a * b);  // the vertical in the body
    out[4] = ((across - axial) * q * r + height * gravity * uy) / across;
    out[5] = ((axial - across) * p * r - height * gravity * ux) / across;
    out[6] = 0;
  }
  Vector points(const double *y) const override {
    const double s = std::sqrt(y[0] * y[0] + y[1] * y[1] + y[2] * y[2] + y[3] * y[3]);
    const double a = y[0] / s, b = y[1] / s, c = y[2] / s, d = y[3] / s;
    const double x[3] = {1 - 2 * (c * c + d * d), 2 * (b * c + a * d), 2 * (b * d - a * c)};
    const double z[3] = {2 * (b * d + a * c), 2 * (c * d - a * b), 1 - 2 * (b * b + c * c)};
    Vector out;
    for (double rim : {0.0, radius})
      for (int k = 0; k < 3; ++k) out.push_back(height * z[k] + rim * x[k]);
    return out;
  }
};

/// The stiff governor: angle of the shaft, height of the slider, angle of the arms, and the rates of the last two; the axial
/// momentum is constant.
struct Governor : Problem {
  double mass = 5.3, arm = 0.9716981132075473, across = 0.09575721698113207, thin = 5e-6, offset = 0.05, slider = 3;
  double momentum;
  Governor() : Problem(5, 0, 10, {0, 0.5, M_PI / 6, 0, 0}) { momentum = inertia(M_PI / 6) * 2 * M_PI; }
  double inertia(double alpha) const {
    const double c = std::cos(alpha), s = std::sin(alpha), reach = offset + arm * c;
    return 5e-6 + 0.005 + 2 * (mass * reach * reach + across * c * c + thin * s * s);
  }
  void rate(double, const double *y, double *out) const override {
    const double s = std::sin(y[2]), c = std::cos(y[2]), gravity = 9.81;
    const double spin = momentum / inertia(y[2]);
    const double grows = -4 * (mass * (offset + arm * c) * arm + (across - thin) * c) * s;
    const double x = 0.5 * c, z = 1 - 0.5 * s - y[1], length = std::sqrt(x * x + z * z);
    const double by_alpha = (-0.5 * s * x - 0.5 * c * z) / length, by_height = -z / length;
    const double tension = 8e5 * (length - 0.5) + 4e4 * (by_alpha * y[4] + by_height * y[3]);
    out[0] = spin;
    out[1] = y[3];
    out[2] = y[4];
    out[3] = -gravity - 2 * tension * by_height / slider;
    out[4] = (0.5 * grows * spin * spin + 2 * mass * gravity * arm * c - 2 * tension * by_alpha) /
             (2 * (across + mass * arm * arm));
  }
  Vector points(const double *y) const override { return {y[1], std::sin(y[2])}; }
};

/// The car axis of the Test Set for IVP Solvers.
struct CarAxis : Problem {
  CarAxis() : Problem(4, 2, 3, {0, 0.5, 1, 0.5, -0.5, 0, -0.5, 0}) {}
  void terms(double t, const double *q, const double *v, Terms &out) const override {
    const double k = 5e-4, w = 10, h = 0.1;
    const double yb = h * std::sin(w * t), xb = std::sqrt(1 - yb * yb);
    const double ybp = h * w * std::cos(w * t), ybpp = -w * w * yb;
    const double xbp = -yb * ybp / xb, xbpp = -(ybp * ybp + yb * ybpp + xbp * xbp) / xb;
    const double left = std::hypot(q[0], q[1]), dx = q[2] - xb, dy = q[3] - yb, right = std::hypot(dx, dy);
    std::fill(out.mass.begin(), out.mass.end(), 0.0);
    for (int i = 0; i < 4; ++i) out.mass[5 * i] = k;
    out.force = {(0.5 / left - 1) * q[0], (0.5 / left - 1) * q[1] - k, (0.5 / right - 1) * dx, (0.5 / right - 1) * dy - k};
    const double ex = q[0] - q[2], ey = q[1] - q[3], vx = v[0] - v[2], vy = v[1] - v[3];
    out.violation = {q[0] * xb + q[1] * yb, ex * ex + ey * ey - 1};
    out.jacobian = {xb, yb, 0, 0, 2 * ex, 2 * ey, -2 * ex, -2 * ey};
    out.rate = {q[0] * xbp + q[1] * ybp, 0};
    out.gamma = {-(2 * v[0] * xbp + 2 * v[1] * ybp + q[0] * xbpp + q[1] * ybpp), -2 * (vx * vx + vy * vy)};
  }
  Vector points(const double *y) const override { return {y[0], y[1], y[2], y[3]}; }
};

/// Andrews' squeezer of the Test Set for IVP Solvers: seven angles β, Θ, γ, Φ, δ, Ω, ε and six equations of its loops.
struct Squeezer : Problem {
  Squeezer()
      : Problem(7, 6, 0.05,
                {-0.0617138900142764496, 0, 0.455279819163070380, 0.222668390165885885, 0.487364979543842550,
                 -0.222668390165885885, 1.23054744454982119, 0, 0, 0, 0, 0, 0, 0}) {}
  void terms(double, const double *q, const double *v, Terms &out) const override {
    const double m1 = .04325, m2 = .00365, m3 = .02373, m4 = .00706, m5 = .07050, m6 = .00706, m7 = .05498;
    const double i1 = 2.194e-6, i2 = 4.410e-7, i3 = 5.255e-6, i4 = 5.667e-7, i5 = 1.169e-5, i6 = 5.667e-7, i7 = 1.912e-5;
    const double xa = -.06934, ya = -.00227, xb = -.03635, yb = .03273, xc = .014, yc = .072, c0 = 4530, l0 = .07785;
    const double d = .028, da = .0115, e = .02, ea = .01421, rr = .007, ra = .00092, ss = .035, sa = .01874, sb = .01043;
    const double sc = .018, sd = .02, ta = .02308, tb = .00916, u = .04, ua = .01228, ub = .00449, zf = .02, zt = .04;
    const double fa = .01421, mom = .033;
    const double be = q[0], th = q[1], ga = q[2], ph = q[3], de = q[4], om = q[5], ep = q[6];
    const double bep = v[0], thp = v[1], gap = v[2], php = v[3], dep = v[4], omp = v[5], epp = v[6];
    const double sg = std::sin(ga), cg = std::cos(ga), l4 = e - ea, l6 = zf - fa;
    auto mass = [&](int i, int j, double x) { out.mass[7 * i + j] = out.mass[7 * j + i] = x; };
    std::fill(out.mass.begin(), out.mass.end(), 0.0);
    mass(0, 0, m1 * ra * ra + m2 * (rr * rr - 2 * da * rr * std::cos(th) + da * da) + i1 + i2);
    mass(0, 1, m2 * (da * da - da * rr * std::cos(th)) + i2);
    mass(1, 1, m2 * da * da + i2);
    mass(2, 2, m3 * (sa * sa + sb * sb) + i3);
    mass(3, 3, m4 * l4 * l4 + i4);
    mass(3, 4, m4 * (l4 * l4 + zt * l4 * std::sin(ph)) + i4);
    mass(4, 4, m4 * (zt * zt + 2 * zt * l4 * std::sin(ph) + l4 * l4) + m5 * (ta * ta + tb * tb) + i4 + i5);
    mass(5, 5, m6 * l6 * l6 + i6);
    mass(5, 6, m6 * (l6 * l6 - u * l6 * std::sin(om)) + i6);
    mass(6, 6, m6 * (l6 * l6 - 2 * u * l6 * std::sin(om) + u * u) + m7 * (ua * ua + ub * ub) + i6 + i7);
    const double xd = sd * cg + sc * sg + xb, yd = sd * sg - sc * cg + yb;
    const double spring = std::hypot(xd - xc, yd - yc), force = -c0 * (spring - l0) / spring;
    const double fx = force * (xd - xc), fy = force * (yd - yc);
    out.force = {mom - m2 * da * rr * thp * (thp + 2 * bep) * std::sin(th), m2 * da * rr * bep * bep * std::sin(th),
                 fx * (sc * cg - sd * sg) + fy * (sd * cg + sc * sg), m4 * zt * l4 * dep * dep * std::cos(ph),
                 -m4 * zt * l4 * php * (php + 2 * dep) * std::cos(ph), -m6 * u * l6 * epp * epp * std::cos(om),
                 m6 * u * l6 * omp * (omp + 2 * epp) * std::cos(om)};
    // Links as length, angle and the coordinates that the angle is the sum of.
    const double sbe = std::sin(be), cbe = std::cos(be), sbt = std::sin(be + th), cbt = std::cos(be + th);
    const double spd = std::sin(ph + de), cpd = std::cos(ph + de), sde = std::sin(de), cde = std::cos(de);
    const double soe = std::sin(om + ep), coe = std::cos(om + ep), sep = std::sin(ep), cep = std::cos(ep);
    const double x = rr * cbe - d * cbt, y = rr * sbe - d * sbt;
    out.violation = {x - ss * sg - xb,          y + ss * cg - yb,          x - e * spd - zt * cde - xa,
                     y + e * cpd - zt * sde - ya, x - zf * coe - u * sep - xa, y - zf * soe + u * cep - ya};
    std::fill(out.jacobian.begin(), out.jacobian.end(), 0.0);
    auto row = [&](int i, std::initializer_list<std::pair<int, double>> entries) {
      for (auto [j, g] : entries) out.jacobian[7 * i + j] = g;
    };
    for (int i : {0, 2, 4}) row(i, {{0, -y}, {1, d * sbt}}), row(i + 1, {{0, x}, {1, -d * cbt}});
    row(0, {{2, -ss * cg}}), row(1, {{2, -ss * sg}});
    row(2, {{3, -e * cpd}, {4, -e * cpd + zt * sde}}), row(3, {{3, -e * spd}, {4, -e * spd - zt * cde}});
    row(4, {{5, zf * soe}, {6, zf * soe - u * cep}}), row(5, {{5, -zf * coe}, {6, -zf * coe - u * sep}});
    const double bt = (bep + thp) * (bep + thp), pd = (php + dep) * (php + dep), oe = (omp + epp) * (omp + epp);
    const double ax = -rr * cbe * bep * bep + d * cbt * bt, ay = -rr * sbe * bep * bep + d * sbt * bt;
    out.gamma = {-(ax + ss * sg * gap * gap), -(ay - ss * cg * gap * gap),
                 -(ax + e * spd * pd + zt * cde * dep * dep), -(ay - e * cpd * pd + zt * sde * dep * dep),
                 -(ax + zf * coe * oe + u * sep * epp * epp), -(ay + zf * soe * oe - u * cep * epp * epp)};
    std::fill(out.rate.begin(), out.rate.end(), 0.0);
  }
  Vector points(const double *y) const override { return {std::cos(y[0]), std::sin(y[0])}; }
};
