// Radau IIA of order 5 (Hairer, Wanner, Solving Ordinary Differential Equations II, section IV.8) for y' = F(t, y), with the
// step control, starting values and error estimate of the authors' program RADAU5 and a Jacobian by differences.
#pragma once
#include "dae.hpp"

struct Radau5 {
  const double nodes[3] = {(4 - std::sqrt(6.0)) / 10, (4 + std::sqrt(6.0)) / 10, 1};
  const double t[3][3] = {{0.091232394870892943, -0.14125529502095421, -0.030029194105147424},
                          {0.24171793270710702, 0.20412935229379993, 0.38294211275726194},
                          {0.96604818261509294, 1, 0}};
  const double inverse[3][3] = {{4.3255798900631553, 0.33919925181580987, 0.54177053993587487},
                                {-4.1787185915519047, -0.32768282076106239, 0.47662355450055045},
                                {-0.50287263494578688, 2.5719269498556054, -0.59603920482822492}};
  const double real = 3.6378342527444957, estimate[3] = {-10.048809399827416, 1.3821427331607489, -1.0 / 3};
  const std::complex<double> pair{2.6810828736277521, 3.0504301992474105};

  /// The polynomial of the step at the part s, less the start of the step.
  double inside(double s, const Vector &z, int i, int n) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      double weight = s / nodes[k];
      for (int l = 0; l < 3; ++l)
        if (l != k) weight *= (s - nodes[l]) / (nodes[k] - nodes[l]);
      sum += weight * z[k * n + i];
    }
    return sum;
  }

  /// Integrates to the end. `project` corrects a new state, `observe(t0, h, y0, z)` sees each step.
  template <typename Rate, typename Project, typename Observe>
  void integrate(Rate rate, Project project, Observe observe, Vector y, double end, double given) const {
    const int n = static_cast<int>(y.size());
    const double tolerance = 0.1 * std::pow(given, 2.0 / 3), precision = 2.2e-16;
    const double newton = std::max(10 * precision / tolerance, std::min(0.03, std::sqrt(tolerance)));
    Vector f(n), z(3 * n), w(3 * n), values(3 * n), old(3 * n), scale(n), other(n), next(n), jacobian(n * n), error(n);
    Factors<double> first;
    Factors<std::complex<double>> second;
    std::vector<std::complex<double>> both(n);
    double time = 0, h = 1e-6 * end, h_old = 0, error_old = 1e-2, rate_old = 1, faccon = 1;
    bool fresh = false, has_factor = false, rejected = false, start = true;
    auto norm = [&](const double *x, int count) {
      double sum = 0;
      for (int i = 0; i < count; ++i) sum += (x[i] / scale[i % n]) * (x[i] / scale[i % n]);
      return std::sqrt(sum / count);
    };
    rate(time, y.data(), f.data());
    for (int tries = 0; time < end; ++tries) {
      if (tries > 3000000 || !(h > 1e-15)) throw std::runtime_error("the step became too small");
      if (time + 1.01 * h >= end) h = end - time, has_factor = false;
      for (int i = 0; i < n; ++i) scale[i] = tolerance * (1 + std::abs(y[i]));
      if (!fresh && !has_factor) {
        for (int j = 0; j < n; ++j) {
          const double kept = y[j], delta = std::sqrt(precision * std::max(1e-5, std::abs(kept)));
          y[j] += delta;
          rate(time, y.data(), other.data());
          y[j] = kept;
          for (int i = 0; i < n; ++i) jacobian[i * n + j] = (other[i] - f[i]) / delta;
        }
        fresh = true;
      }
      if (!has_factor) {
        Vector a(n * n);
        std::vector<std::complex<double>> b(n * n);
        for (int i = 0; i < n * n; ++i) b[i] = a[i] = -jacobian[i];
        for (int i = 0; i < n; ++i) a[i * (n + 1)] += real / h, b[i * (n + 1)] += pair / h;
        first.factor(std::move(a));
        second.factor(std::move(b));
        has_factor = true;
      }
      // Starting values from the polynomial of the step before.
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < n; ++i)
          z[k * n + i] = start ? 0 : inside(1 + nodes[k] * h / h_old, old, i, n) - old[2 * n + i];
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < n; ++i)
          w[k * n + i] = inverse[k][0] * z[i] + inverse[k][1] * z[n + i] + inverse[k][2] * z[2 * n + i];
      bool converged = false;
      double size_old = 0, theta = std::abs(rate_old);
      faccon = std::pow(std::max(faccon, precision), 0.8);
      int iterations = 0;
      for (const int most = 7; iterations < most; ++iterations) {
        for (int k = 0; k < 3; ++k) {
          for (int i = 0; i < n; ++i) next[i] = y[i] + z[k * n + i];
          rate(time + nodes[k] * h, next.data(), &values[k * n]);
        }
        for (int i = 0; i < n; ++i) {
          double r[3];
          for (int k = 0; k < 3; ++k)
            r[k] = inverse[k][0] * values[i] + inverse[k][1] * values[n + i] + inverse[k][2] * values[2 * n + i];
          other[i] = r[0] - real / h * w[i];
          both[i] = std::complex<double>(r[1], r[2]) - pair / h * std::complex<double>(w[n + i], w[2 * n + i]);
        }
        first.solve(other.data());
        second.solve(both.data());
        for (int i = 0; i < n; ++i) values[i] = other[i], values[n + i] = both[i].real(), values[2 * n + i] = both[i].imag();
        const double size = norm(values.data(), 3 * n);
        if (iterations > 0) {
          const double quotient = size / size_old;
          theta = iterations == 1 ? quotient : std::sqrt(quotient * rate_old);
          rate_old = quotient;
          if (!(theta < 0.99)) break;
          faccon = theta / (1 - theta);
          if (faccon * size * std::pow(theta, most - 1 - iterations) > newton * 10) break;
        }
        size_old = std::max(size, precision);
        for (int i = 0; i < 3 * n; ++i) w[i] += values[i];
        for (int i = 0; i < n; ++i)
          for (int k = 0; k < 3; ++k)
            z[k * n + i] = t[k][0] * w[i] + t[k][1] * w[n + i] + t[k][2] * w[2 * n + i];
        if (faccon * size <= newton) {
          converged = true;
          ++iterations;
          break;
        }
      }
      if (!converged) {
        h *= 0.5, has_factor = false, rejected = true, faccon = 1;
        continue;
      }
      auto filtered = [&](const double *f0) {
        for (int i = 0; i < n; ++i) {
          error[i] = f0[i];
          for (int k = 0; k < 3; ++k) error[i] += estimate[k] / h * z[k * n + i];
        }
        first.solve(error.data());
        return std::max(norm(error.data(), n), 1e-10);
      };
      double off = filtered(f.data());
      if (off >= 1 && (start || rejected)) {
        for (int i = 0; i < n; ++i) next[i] = y[i] + error[i];
        rate(time, next.data(), other.data());
        off = filtered(other.data());
      }
      const double safety = std::min(0.9, 0.9 * 15 / (iterations + 14.0));
      double divide = std::clamp(std::pow(off, 0.25) / safety, 1.0 / 8, 5.0);
      if (!(off < 1)) {
        h = start ? 0.1 * h : h / divide;
        rejected = true, has_factor = false;
        continue;
      }
      if (!start) {
        const double predicted = h_old / h * std::pow(off * off / error_old, 0.25) / 0.9;
        divide = std::max(divide, std::clamp(predicted, 1.0 / 8, 5.0));
      }
      observe(time, h, y, z);
      error_old = std::max(1e-2, off);
      for (int i = 0; i < n; ++i) y[i] += z[2 * n + i];
      time = h == end - time ? end : time + h;
      project(time, y);
      old = z;
      h_old = h;
      start = false;
      rate(time, y.data(), f.data());
      fresh = false;
      const double wanted = rejected ? std::min(h, h / divide) : h / divide;
      rejected = false;
      // A factor that converges well and a step that would hardly change are kept.
      if (theta <= 1e-3 && wanted / h >= 1 && wanted / h <= 1.2) continue;
      h = wanted, has_factor = false;
      if (theta <= 1e-3) fresh = true;
    }
  }
};
