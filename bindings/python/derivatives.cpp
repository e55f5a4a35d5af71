// Values and exact derivatives at a solved shape, without the interpreter lock.
#include "equilibrium.hpp"

#include <pybind11/stl.h>

namespace coapt::python {
namespace {

using Figures = std::vector<const FigureOfMerit*>;

// sum of weights times metrics: one adjoint system for all of them.
class WeightedSum final : public Metric {
 public:
  WeightedSum(std::vector<const Metric*> metrics, Vector weights)
      : Metric("sum"), metrics_(std::move(metrics)), weights_(std::move(weights)) {}

  double evaluate(const Points& x, Points* gradient) const override {
    double sum = 0;
    Points one(3, x.cols());
    if (gradient != nullptr) gradient->setZero(3, x.cols());
    for (size_t k = 0; k < metrics_.size(); ++k) {
      const double weight = weights_[static_cast<Eigen::Index>(k)];
      if (weight == 0) continue;
      sum += weight * metrics_[k]->evaluate(x, gradient == nullptr ? nullptr : &one);
      if (gradient != nullptr) *gradient += weight * one;
    }
    return sum;
  }

  Vector partial(const Parameter& parameter, const Points& x) const override {
    Vector sum = Vector::Zero(parameter.value().size());
    for (size_t k = 0; k < metrics_.size(); ++k)
      sum += weights_[static_cast<Eigen::Index>(k)] * metrics_[k]->partial(parameter, x);
    return sum;
  }

 private:
  std::vector<const Metric*> metrics_;
  Vector weights_;
};

// Of this equilibrium: others look into other terms and nodes.
std::vector<const Metric*> metrics_of(const Followed& followed, const Figures& figures) {
  std::vector<const Metric*> metrics;
  std::vector<std::string> defects;
  for (const FigureOfMerit* figure : figures) {
    if (figure->of.get() != &followed)
      defects.push_back("metric \"" + figure->metric->name() +
                        "\": was made for another equilibrium; make it for this one");
    metrics.push_back(figure->metric.get());
  }
  if (!defects.empty()) throw InputError(defects);
  return metrics;
}

py::array matrix_array(const Eigen::MatrixXd& matrix) {
  py::array_t<double> array({matrix.rows(), matrix.cols()});
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      array.mutable_data(), matrix.rows(), matrix.cols()) = matrix;
  return array;
}

// At the present shape, solved or not.
py::array evaluate(Followed& self, const Figures& figures) {
  const std::vector<const Metric*> metrics = metrics_of(self, figures);
  Vector values(static_cast<Eigen::Index>(metrics.size()));
  self.at_work([&] {
    const Points x = self.equilibrium().positions();
    for (size_t k = 0; k < metrics.size(); ++k)
      values[static_cast<Eigen::Index>(k)] = metrics[k]->evaluate(x, nullptr) + figures[k]->offset;
  });
  return vector_array(values);
}

py::tuple value_and_grad(Followed& self, const FigureOfMerit& figure) {
  const Metric& metric = *metrics_of(self, {&figure}).front();
  const Derivatives found = self.at_work([&] { return self.equilibrium().derivatives(metric); });
  return py::make_tuple(found.value + figure.offset, vector_array(found.gradient));
}

py::array jacobian(Followed& self, const Figures& figures) {
  const std::vector<const Metric*> metrics = metrics_of(self, figures);
  return matrix_array(self.at_work([&] { return self.equilibrium().jacobian(metrics); }));
}

py::array weighted_gradient(Followed& self, const Figures& figures, const Numbers& weights) {
  const WeightedSum sum(metrics_of(self, figures), vector_in(weights));
  return vector_array(self.at_work([&] { return self.equilibrium().derivatives(sum).gradient; }));
}

py::array gauss_newton_product(Followed& self, const Figures& figures, const Numbers& change) {
  const std::vector<const Metric*> metrics = metrics_of(self, figures);
  const Vector along = vector_in(change);
  return vector_array(self.at_work([&] { return self.equilibrium().gauss_newton_product(metrics, along); }));
}

py::array metric_covariance(Followed& self, const Figures& figures, const Numbers& covariance) {
  const std::vector<const Metric*> metrics = metrics_of(self, figures);
  const Eigen::Map<const Eigen::MatrixXd> given(covariance.data(), covariance.shape(1), covariance.shape(0));
  const Eigen::MatrixXd columns = given.transpose();
  return matrix_array(self.at_work([&] { return self.equilibrium().metric_covariance(metrics, columns); }));
}

py::array response(Followed& self, const Numbers& change) {
  const Vector along = vector_in(change);
  return array_of(self.at_work([&] { return self.equilibrium().response(along); }));
}

py::array pull_back(Followed& self, const Numbers& weights) {
  const auto columns = points_in(weights);
  return vector_array(self.at_work([&] { return self.equilibrium().pull_back(columns); }));
}

py::list switches(Followed& self, const Numbers& change) {
  const Vector along = vector_in(change);
  return switch_list(self.at_work([&] { return self.equilibrium().switches(along); }));
}

py::list kinks(Followed& self) {
  return switch_list(self.at_work([&]() -> std::vector<Switch> { return self.equilibrium().kinks(); }));
}

}  // namespace

void define_derivatives(py::class_<Followed, std::shared_ptr<Followed>>& type) {
  const auto metrics = py::arg("metrics"), change = py::arg("change");
  type.def("evaluate", &evaluate, metrics)
      .def("value_and_grad", &value_and_grad, py::arg("metric"))
      .def("jacobian", &jacobian, metrics)
      .def("weighted_gradient", &weighted_gradient, metrics, py::arg("weights"))
      .def("gauss_newton_product", &gauss_newton_product, metrics, change)
      .def("metric_covariance", &metric_covariance, metrics, py::arg("covariance"))
      .def("response", &response, change)
      .def("pull_back", &pull_back, py::arg("weights"))
      .def("kinks", &kinks)
      .def("switches", &switches, change);
}

}  // namespace coapt::python
