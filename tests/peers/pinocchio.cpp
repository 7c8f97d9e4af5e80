// Pinocchio among the compared programs: its recursions for the accelerations, with integrators of our own around them.
//
// `pinocchio-peer KIND SIZE DURATION`, then lines `REPEATS FILE NAME=VALUE ...` on standard input, answered as by
// triad.rs. Settings: integrator=rk4 rate=N (steps a second) or integrator=dop853 tolerance=E; for loops also
// gain=K (Baumgarte with K^2 and 2 K) and mu=M (the proximal parameter of Pinocchio's solver).

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <pinocchio/multibody.hpp>
#include <pinocchio/multibody/joint.hpp>

#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/constrained-dynamics.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/algorithm/model.hpp>

#include "dop853.hpp"

namespace pin = pinocchio;
using Vector = Eigen::VectorXd;
using Ref = Eigen::Ref<const Vector>;
using Point = Eigen::Vector3d;
using Settings = std::map<std::string, std::string>;

/// A mechanism: the tree, its loops, its start and the points that are compared.
struct Mechanism {
  pin::Model model;
  std::vector<pin::RigidConstraintModel> loops;
  Vector start;
  std::vector<std::pair<pin::JointIndex, Point>> points;
  bool quaternions = false;
};

pin::SE3 at(double x, double y, double z) { return pin::SE3(Eigen::Matrix3d::Identity(), Point(x, y, z)); }

pin::Inertia inertia(Point centre, double x, double y, double z) {
  return pin::Inertia(1, centre, Eigen::Matrix3d(Point(x, y, z).asDiagonal()));
}

pin::JointIndex add(pin::Model &model, pin::JointIndex parent, const pin::JointModel &joint, const pin::SE3 &place,
                    const pin::Inertia &inertia) {
  auto index = model.addJoint(parent, joint, place, "joint" + std::to_string(model.njoints));
  model.appendBodyToJoint(index, inertia, pin::SE3::Identity());
  return index;
}

void pendulum(Mechanism &m) {
  m.model.gravity.linear() = Point(0, -9.81, 0);
  auto bob = add(m.model, 0, pin::JointModelRZ(), pin::SE3::Identity(), inertia(Point(-1, 0, 0), 0, 0, 0));
  m.points = {{bob, Point(-1, 0, 0)}};
  m.start = Vector::Zero(2);
}

/// Each coupler hangs on the upright at its left; its right end is held at the tip of the next.
void four_bar(Mechanism &m, int windows) {
  m.model.gravity.linear() = Point(0, -9.81, 0);
  const double j = 1.0 / 12.0;
  std::vector<pin::JointIndex> uprights, couplers;
  std::vector<double> rates;
  for (int i = 0; i <= windows; ++i) {
    uprights.push_back(add(m.model, 0, pin::JointModelRZ(), at(i, 0, 0), inertia(Point(0, 0.5, 0), j, j, j)));
    rates.push_back(-1);
    if (i < windows) {
      auto coupler = add(m.model, uprights.back(), pin::JointModelRZ(), at(0, 1, 0), inertia(Point(0.5, 0, 0), j, j, j));
      couplers.push_back(coupler);
      rates.push_back(1);
    }
  }
  for (int i = 0; i < windows; ++i)
    m.loops.emplace_back(pin::CONTACT_3D, m.model, couplers[i], at(1, 0, 0), uprights[i + 1], at(0, 1, 0), pin::LOCAL);
  m.points = {{uprights[0], Point(0, 1, 0)}};
  m.start = Vector::Zero(2 * m.model.nv);
  m.start.tail(m.model.nv) = Eigen::Map<Vector>(rates.data(), m.model.nv);
}

void chain(Mechanism &m, int rods) {
  m.model.gravity.linear() = Point(0, 0, -9.81);
  const double radius = 0.05, axial = radius * radius / 2, across = (3 * radius * radius + 1) / 12;
  pin::JointIndex parent = 0;
  m.start = Vector::Zero(7 * rods);
  Point before = Point::Zero();
  for (int i = 0; i < rods; ++i) {
    parent = add(m.model, parent, pin::JointModelSpherical(), at(i > 0, 0, 0), inertia(Point(0.5, 0, 0), axial, across, across));
    m.points.emplace_back(parent, Point(1, 0, 0));
    Point rate(1, 0.4 * std::cos(i + 1.0), 0.8 * std::sin(i + 1.0));
    m.start[4 * i + 3] = 1;
    m.start.segment<3>(4 * rods + 3 * i) = rate - before;
    before = rate;
  }
  m.quaternions = true;
}

void top(Mechanism &m) {
  m.model.gravity.linear() = Point(0, 0, -9.81);
  const double axial = 0.15 * 0.15 / 2;
  auto body = add(m.model, 0, pin::JointModelSpherical(), pin::SE3::Identity(), inertia(Point(0, 0, 0.2), axial / 2, axial / 2, axial));
  m.points = {{body, Point(0, 0, 0.2)}, {body, Point(0.15, 0, 0.2)}};
  m.start = Vector::Zero(7);
  m.start << 0.5, 0, 0, std::sqrt(0.75), 0, 0, 60;
  m.quaternions = true;
}

/// Rates of the state (q, v), by the articulated-body recursion or, with loops, by the constrained dynamics.
class Plant {
 public:
  Plant(Mechanism &mechanism, const Settings &settings)
      : m(mechanism), data(m.model), torque(Vector::Zero(m.model.nv)), q(m.model.nq), v(m.model.nv) {
    if (m.loops.empty()) return;
    const double gain = std::stod(settings.at("gain"));
    for (auto &loop : m.loops) {
      loop.baumgarte_corrector_parameters().Kp = gain * gain;
      loop.baumgarte_corrector_parameters().Kd = 2 * gain;
      loop_data.emplace_back(loop);
    }
    proximal = pin::ProximalSettings(1e-13, std::stod(settings.at("mu")), 20);
    pin::initConstraintDynamics(m.model, data, m.loops, loop_data);
  }

  void rate(const Vector &y, Vector &change) {
    const int nq = m.model.nq, nv = m.model.nv;
    q = y.head(nq);
    v = y.tail(nv);
    if (m.quaternions) {
      for (int i = 0; i < nq / 4; ++i) {
        auto e = y.segment<4>(4 * i);
        auto w = y.segment<3>(nq + 3 * i);
        Point part = e.head<3>();
        Point omega = w;
        change.segment<3>(4 * i) = 0.5 * (e[3] * omega + part.cross(omega));
        change[4 * i + 3] = -0.5 * part.dot(omega);
        q.segment<4>(4 * i).normalize();
      }
    } else {
      change.head(nq) = v;
    }
    if (m.loops.empty())
      change.tail(nv) = pin::aba(m.model, data, Ref(q), Ref(v), Ref(torque), pin::Convention::LOCAL);
    else
      change.tail(nv) = pin::constraintDynamics(m.model, data, q, v, torque, m.loops, loop_data, proximal);
  }

  void normalize(Vector &y) const {
    if (m.quaternions)
      for (int i = 0; i < m.model.nq / 4; ++i) y.segment<4>(4 * i).normalize();
  }

  void points(const Vector &y, std::vector<double> &out) {
    pin::forwardKinematics(m.model, data, Ref(y.head(m.model.nq)));
    for (const auto &[joint, local] : m.points) {
      Point p = data.oMi[joint].act(local);
      out.insert(out.end(), p.data(), p.data() + 3);
    }
  }

 private:
  Mechanism &m;
  pin::Data data;
  Vector torque, q, v;
  std::vector<pin::RigidConstraintData> loop_data;
  pin::ProximalSettings proximal;
};

/// Classical Runge-Kutta of order 4 with `rate` steps a second.
template <typename Observe>
void rk4(Plant &plant, Vector y, double duration, int rate, Observe observe) {
  const double h = 1.0 / rate;
  const long steps = std::lround(duration * rate);
  Vector a(y.size()), b(y.size()), c(y.size()), d(y.size()), trial(y.size());
  for (long step = 1; step <= steps; ++step) {
    plant.rate(y, a);
    trial = y + h / 2 * a;
    plant.rate(trial, b);
    trial = y + h / 2 * b;
    plant.rate(trial, c);
    trial = y + h * c;
    plant.rate(trial, d);
    y += h / 6 * (a + 2 * b + 2 * c + d);
    plant.normalize(y);
    observe(static_cast<double>(step) / rate, y);
  }
}

/// DOP853 with its own step control, relative and absolute tolerance alike.
template <typename Observe>
void dop853(Plant &plant, Vector y, double duration, double tolerance, Observe observe) {
  std::vector<Vector> k(13, Vector::Zero(y.size()));
  Vector trial(y.size()), sum(y.size());
  double t = 0, h = 1e-3;
  plant.rate(y, k[0]);
  for (long tries = 0; t < duration; ++tries) {
    if (tries > 2000000 || !(h > 1e-14)) throw std::runtime_error("the step became too small at " + std::to_string(t));
    h = std::min(h, duration - t);
    for (int stage = 1; stage <= 12; ++stage) {
      trial = y;
      for (auto [j, a] : DOP853_A[stage]) trial.noalias() += h * a * k[j];
      if (stage < 12) plant.rate(trial, k[stage]);
    }
    auto norm = [&](const Row &row) {
      sum.setZero();
      for (auto [j, e] : row) sum.noalias() += e * k[j];
      auto scale = tolerance * (1 + y.array().abs().max(trial.array().abs()));
      return std::sqrt((sum.array() / scale).square().mean());
    };
    const double e5 = norm(DOP853_E5), e3 = norm(DOP853_E3);
    const double error = e5 == 0 && e3 == 0 ? 0 : h * e5 * e5 / std::sqrt(e5 * e5 + 0.01 * e3 * e3);
    if (!(error < 1)) {
      h *= std::isfinite(error) ? std::max(0.333, 0.9 * std::pow(error, -0.125)) : 0.1;
      continue;
    }
    t = h == duration - t ? duration : t + h;
    y = trial;
    plant.normalize(y);
    observe(t, y);
    if (t < duration) plant.rate(y, k[0]);
    h *= std::clamp(0.9 * std::pow(std::max(error, 1e-12), -0.125), 0.333, 6.0);
  }
}

template <typename Observe>
void integrate(Plant &plant, const Mechanism &m, double duration, const Settings &settings, Observe observe) {
  if (settings.at("integrator") == "rk4")
    rk4(plant, m.start, duration, std::stoi(settings.at("rate")), observe);
  else
    dop853(plant, m.start, duration, std::stod(settings.at("tolerance")), observe);
}

/// Processor seconds of one run: the mean of a batch so long that the clock's own time and resolution do not count.
template <typename Run>
double batch(Run run) {
  const double shortest = 0.02;
  for (int count = 1;;) {
    const auto start = std::clock();
    for (int i = 0; i < count; ++i) run();
    const double spent = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    if (spent >= shortest) return spent / count;
    count = static_cast<int>(1.5 * shortest * count / std::max(spent, 1e-6)) + 1;
  }
}

/// Answers one request.
std::string measure(Mechanism &m, double duration, const std::string &line) {
  std::istringstream words(line);
  int repeats;
  std::string file, word;
  words >> repeats >> file;
  Settings settings;
  while (words >> word) settings[word.substr(0, word.find('='))] = word.substr(word.find('=') + 1);
  Plant plant(m, settings);
  if (file != "-") {
    std::vector<double> out{0};
    plant.points(m.start, out);
    integrate(plant, m, duration, settings, [&](double t, const Vector &y) {
      out.push_back(t);
      plant.points(y, out);
    });
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char *>(out.data()), 8 * out.size());
  }
  std::ostringstream times;
  times.precision(9);
  const auto run = [&] { integrate(plant, m, duration, settings, [](double, const Vector &) {}); };
  for (int i = 0; i < repeats; ++i) times << (i ? ", " : "") << batch(run);
  return "{\"times\": [" + times.str() + "]}";
}

int main(int count, char **arguments) {
  if (count != 4) {
    std::cerr << "usage: pinocchio-peer KIND SIZE DURATION\n";
    return 2;
  }
  const std::string kind = arguments[1];
  Mechanism m;
  if (kind == "pendulum") pendulum(m);
  else if (kind == "four-bar") four_bar(m, std::stoi(arguments[2]));
  else if (kind == "chain") chain(m, std::stoi(arguments[2]));
  else top(m);
  for (std::string line; std::getline(std::cin, line);) {
    try {
      std::cout << measure(m, std::stod(arguments[3]), line) << std::endl;
    } catch (const std::exception &error) {
      std::cout << "{\"error\": \"" << error.what() << "\"}" << std::endl;
    }
  }
}
