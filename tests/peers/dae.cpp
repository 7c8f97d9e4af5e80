// SUNDIALS' IDA and a Radau method of order 5 on problems that are index-reduced by hand, as a program that stiff.py compares:
// `dae-peer PROBLEM`, then lines `REPEATS FILE solver=ida-1|ida-2|radau tolerance=X samples=N`.
#include "radau5.hpp"

#include <ctime>
#include <fstream>
#include <ida/ida.h>
#include <iostream>
#include <map>
#include <memory>
#include <nvector/nvector_serial.h>
#include <sstream>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

using Settings = std::map<std::string, std::string>;

/// Accelerations and multipliers: [M Gᵀ; G 0] (q̈, λ) = (f, γ). Keeps the factors.
struct Accelerations {
  const Problem &problem;
  Terms terms;
  Factors<double> factors;
  Vector solution;
  explicit Accelerations(const Problem &p) : problem(p), terms(p.n, p.m), solution(p.n + p.m) {}

  void solve(double t, const double *y) {
    const int n = problem.n, m = problem.m, all = n + m;
    problem.terms(t, y, y + n, terms);
    Vector a(all * all);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) a[i * all + j] = terms.mass[i * n + j];
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < n; ++j) a[(n + i) * all + j] = a[j * all + n + i] = terms.jacobian[i * n + j];
    factors.factor(std::move(a));
    std::copy(terms.force.begin(), terms.force.end(), solution.begin());
    std::copy(terms.gamma.begin(), terms.gamma.end(), solution.begin() + n);
    factors.solve(solution.data());
  }

  /// y' of y = (q, q̇).
  void rate(double t, const double *y, double *out) {
    if (problem.m == 0) return problem.rate(t, y, out);
    solve(t, y);
    std::copy(y + problem.n, y + 2 * problem.n, out);
    std::copy(solution.begin(), solution.begin() + problem.n, out + problem.n);
  }

  /// Draws a state back to the constraints and their rates.
  void project(double t, Vector &y) {
    const int n = problem.n, m = problem.m;
    if (m == 0) return;
    solve(t, y.data());
    Vector step(n + m);
    for (int i = 0; i < m; ++i) step[n + i] = -terms.violation[i];
    factors.solve(step.data());
    for (int i = 0; i < n; ++i) y[i] += step[i];
    problem.terms(t, y.data(), y.data() + n, terms);
    std::fill(step.begin(), step.end(), 0.0);
    for (int i = 0; i < m; ++i) {
      step[n + i] = -terms.rate[i];
      for (int j = 0; j < n; ++j) step[n + i] -= terms.jacobian[i * n + j] * y[n + j];
    }
    factors.solve(step.data());
    for (int i = 0; i < n; ++i) y[n + i] += step[i];
  }
};

/// IDA on y' = F, or of index 2, in the stabilized formulation of Gear, Gupta and Leimkuhler: q' = v − Gᵀ μ, M v' = f − Gᵀ λ,
/// g = 0, G v + ∂g/∂t = 0; or of index 1: q' = v, M v' = f − Gᵀ λ, G v' = γ. Multipliers take no part in the control of the error.
struct Ida {
  const Problem &problem;
  const int index;
  Terms terms;
  Vector value;
  SUNContext context = nullptr;
  void *memory = nullptr;
  N_Vector y = nullptr, rate = nullptr, kind = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver linear = nullptr;
  int size;

  Ida(const Problem &p, int index) : problem(p), index(index), terms(p.n, p.m), value(p.n) {
    size = p.m == 0 ? p.n : 2 * p.n + index * p.m;
    SUNContext_Create(nullptr, &context);
    y = N_VNew_Serial(size, context), rate = N_VClone(y), kind = N_VClone(y);
    matrix = SUNDenseMatrix(size, size, context);
    linear = SUNLinSol_Dense(y, matrix, context);
  }
  ~Ida() {
    IDAFree(&memory);
    SUNLinSolFree(linear);
    SUNMatDestroy(matrix);
    for (N_Vector vector : {y, rate, kind}) N_VDestroy(vector);
    SUNContext_Free(&context);
  }

  static int residual(double t, N_Vector state, N_Vector its_rate, N_Vector out, void *self) {
    static_cast<Ida *>(self)->residual(t, N_VGetArrayPointer(state), N_VGetArrayPointer(its_rate), N_VGetArrayPointer(out));
    return 0;
  }

  void residual(double t, const double *x, const double *dx, double *out) {
    const int n = problem.n, m = problem.m;
    if (m == 0) {
      problem.rate(t, x, value.data());
      for (int i = 0; i < n; ++i) out[i] = dx[i] - value[i];
      return;
    }
    problem.terms(t, x, x + n, terms);
    const double *lambda = x + 2 * n, *mu = lambda + m;
    for (int i = 0; i < n; ++i) {
      out[i] = dx[i] - x[n + i];
      out[n + i] = -terms.force[i];
      for (int j = 0; j < n; ++j) out[n + i] += terms.mass[i * n + j] * dx[n + j];
      for (int k = 0; k < m && index == 2; ++k) out[i] += terms.jacobian[k * n + i] * mu[k];
      for (int k = 0; k < m; ++k) out[n + i] += terms.jacobian[k * n + i] * lambda[k];
    }
    for (int k = 0; k < m; ++k) {
      if (index == 1) {
        out[2 * n + k] = -terms.gamma[k];
        for (int j = 0; j < n; ++j) out[2 * n + k] += terms.jacobian[k * n + j] * dx[n + j];
        continue;
      }
      out[2 * n + k] = terms.violation[k];
      out[2 * n + m + k] = terms.rate[k];
      for (int j = 0; j < n; ++j) out[2 * n + m + k] += terms.jacobian[k * n + j] * x[n + j];
    }
  }

  /// `samples` outputs at equal distances, by IDA's own interpolation.
  template <typename Observe>
  void integrate(double tolerance, int samples, Observe observe) {
    const int n = problem.n, m = problem.m;
    N_VConst(0, y), N_VConst(0, rate), N_VConst(0, kind);
    double *x = N_VGetArrayPointer(y), *dx = N_VGetArrayPointer(rate), *id = N_VGetArrayPointer(kind);
    std::copy(problem.start.begin(), problem.start.end(), x);
    Accelerations consistent(problem);
    consistent.rate(0, x, dx);
    for (int k = 0; k < m; ++k) x[2 * n + k] = consistent.solution[n + k];
    std::fill(id, id + problem.start.size(), 1.0);
    if (memory == nullptr) {
      memory = IDACreate(context);
      IDAInit(memory, residual, 0, y, rate);
      IDASetUserData(memory, this);
      IDASetLinearSolver(memory, linear, matrix);
      IDASetMaxNumSteps(memory, 5000000);
      IDASetId(memory, kind);
      IDASetSuppressAlg(memory, true);
    } else {
      IDAReInit(memory, 0, y, rate);
    }
    IDASStolerances(memory, tolerance, tolerance);
    IDASetStopTime(memory, problem.end);
    observe(0, x);
    for (int k = 1; k <= samples; ++k) {
      double t = 0;
      const int flag = IDASolve(memory, problem.end * k / samples, &t, y, rate, IDA_NORMAL);
      if (flag < 0) throw std::runtime_error("IDA stopped with " + std::to_string(flag));
      observe(t, x);
    }
  }
};

template <typename Observe>
void radau(const Problem &problem, double tolerance, int samples, Observe observe) {
  const Radau5 method;
  Accelerations system(problem);
  const int n = static_cast<int>(problem.start.size());
  Vector inside(n);
  int next = 1;
  observe(0, problem.start.data());
  auto dense = [&](double t0, double h, const Vector &y, const Vector &z) {
    for (double t; next <= samples && (t = problem.end * next / samples) <= t0 + h * (1 + 1e-12); ++next) {
      for (int i = 0; i < n; ++i) inside[i] = y[i] + method.inside((t - t0) / h, z, i, n);
      observe(t, inside.data());
    }
  };
  method.integrate([&](double t, const double *y, double *out) { system.rate(t, y, out); },
                   [&](double t, Vector &y) { system.project(t, y); }, dense, problem.start, problem.end, tolerance);
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
std::string measure(const Problem &problem, Ida &first, Ida &second, const std::string &line) {
  std::istringstream words(line);
  int repeats;
  std::string file, word;
  words >> repeats >> file;
  Settings settings;
  while (words >> word) settings[word.substr(0, word.find('='))] = word.substr(word.find('=') + 1);
  const double tolerance = std::stod(settings.at("tolerance"));
  auto run = [&](int samples, auto observe) {
    if (settings.at("solver") == "ida-1") first.integrate(tolerance, samples, observe);
    else if (settings.at("solver") == "ida-2") second.integrate(tolerance, samples, observe);
    else radau(problem, tolerance, samples, observe);
  };
  if (file != "-") {
    Vector out;
    run(std::stoi(settings.at("samples")), [&](double t, const double *y) {
      out.push_back(t);
      for (double x : problem.points(y)) out.push_back(x);
    });
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char *>(out.data()), 8 * out.size());
  }
  std::ostringstream times;
  times.precision(9);
  for (int i = 0; i < repeats; ++i)
    times << (i ? ", " : "") << batch([&] { run(1, [](double, const double *) {}); });
  return "{\"times\": [" + times.str() + "]}";
}

int main(int count, char **arguments) {
  const std::string name = count == 2 ? arguments[1] : "";
  std::unique_ptr<Problem> problem;
  if (name == "top") problem = std::make_unique<Top>();
  if (name == "governor") problem = std::make_unique<Governor>();
  if (name == "car-axis") problem = std::make_unique<CarAxis>();
  if (name == "squeezer") problem = std::make_unique<Squeezer>();
  if (!problem) {
    std::cerr << "usage: dae-peer top|governor|car-axis|squeezer\n";
    return 2;
  }
  Ida first(*problem, 1), second(*problem, 2);
  for (std::string line; std::getline(std::cin, line);) {
    try {
      std::cout << measure(*problem, first, second, line) << std::endl;
    } catch (const std::exception &error) {
      std::cout << "{\"error\": \"" << error.what() << "\"}" << std::endl;
    }
  }
}
