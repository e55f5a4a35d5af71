#include "python_term.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace coapt::python {
namespace {

using Dense = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Indices = py::array_t<int, py::array::c_style | py::array::forcecast>;
using ElementMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// What an object need not have.
std::string text_or(const py::object& term, const char* attribute, const py::object& otherwise) {
  return py::str(py::getattr(term, attribute, otherwise));
}

std::string name_of(const py::object& term) {
  return text_or(term, "name", py::type::of(term).attr("__name__"));
}

TermRole role_of(const py::object& term) {
  const std::string role = text_or(term, "role", py::str("internal"));
  if (role == "load") return TermRole::Load;
  return role == "contact" ? TermRole::Contact : TermRole::Internal;
}

std::string shape_of(const py::object& array) { return py::str(py::object(array.attr("shape"))); }

// Real numbers of any width; anything else (texts, complex numbers, objects) is not taken.
bool is_real(const py::array& array) {
  const char kind = array.dtype().kind();
  return kind == 'f' || kind == 'i' || kind == 'u';
}

// Negative eigenvalues of every block set to zero, by NumPy for all of them at once.
Dense projected(const Dense& blocks) { return py::module_::import("coapt._terms").attr("projected")(blocks); }

// Calls see(row, column, value) for every entry of a matrix in compressed rows.
template <typename See>
void for_each_entry(const py::object& csr, const See& see) {
  const Indices firsts = Indices::ensure(csr.attr("indptr")), columns = Indices::ensure(csr.attr("indices"));
  const Dense values = Dense::ensure(csr.attr("data"));
  const int* first = firsts.data();
  for (int row = 0; row + 1 < firsts.size(); ++row)
    for (int k = first[row]; k < first[row + 1]; ++k) see(row, columns.data()[k], values.data()[k]);
}

}  // namespace

bool PythonTerm::has_hessian(py::handle term) {
  return py::hasattr(term, "hessian") && !term.attr("hessian").is_none();
}

PythonTerm::PythonTerm(py::object term, const Place& place, Failure& failure, WithoutHessian without)
    : EnergyTerm(name_of(term)),
      term_(std::move(term)),
      role_(role_of(term_)),
      origin_(place.origin),
      node_count_(place.X.cols()),
      failure_(failure),
      without_(without),
      has_hessian_(has_hessian(term_)) {
  read_elements();
  if (!has_hessian_) return;
  const py::object first = term_.attr("hessian")(shown(place.X));
  is_sparse_ = py::hasattr(first, "tocsr");
  if (is_sparse_)
    couple_pairs(pairs_in(first));
  else if (stencils_.nodes.empty())
    refuse("elements: missing; a hessian() of dense blocks needs the nodes of each element, (m, k)");
}

PythonTerm::~PythonTerm() {
  const py::gil_scoped_acquire lock;
  term_ = py::object();
  buffer_ = py::array_t<double>();
}

void PythonTerm::refuse(const std::string& what) const {
  throw InputError("term \"" + name() + "\": " + what);
}

void PythonTerm::read_elements() {
  const py::object given = py::getattr(term_, "elements", py::none());
  if (given.is_none()) return;
  const py::array any = py::array::ensure(given);
  if (!any || any.ndim() != 2 || any.shape(1) < 1 || (any.dtype().kind() != 'i' && any.dtype().kind() != 'u'))
    refuse("elements: expected integers of shape (m, k), the nodes of each element" +
           (any ? ", not shape " + shape_of(any) + " of " + std::string(py::str(any.dtype())) : ""));
  const auto nodes = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>::ensure(any);
  stencils_.width = static_cast<int>(nodes.shape(1));
  for (py::ssize_t k = 0; k < nodes.size(); ++k) {
    const std::int64_t node = nodes.data()[k];
    if (node < 0 || node >= node_count_)
      refuse("elements: node " + std::to_string(node) + " does not exist; the scene has " +
             std::to_string(node_count_) + ", counted from 0");
    stencils_.nodes.push_back(static_cast<int>(node));
  }
}

// A copy: the solver's own positions change while Python may keep what it saw.
py::array_t<double> PythonTerm::shown(const Points& x) const {
  if (buffer_.size() == 0 || buffer_.ref_count() > 1) {
    buffer_ = py::array_t<double>({node_count_, Eigen::Index{3}});
    buffer_.attr("setflags")(py::arg("write") = false);
  }
  Eigen::Map<Points>(const_cast<double*>(buffer_.data()), 3, node_count_) = x.colwise() + origin_;
  return buffer_;
}

double PythonTerm::evaluate(const Points& x, Sink& sink) const {
  const py::gil_scoped_acquire lock;
  try {
    if (!failure_.is_set()) return evaluated(x, sink);
  } catch (...) {
    failure_.keep(std::current_exception());
  }
  throw std::runtime_error("term \"" + name() + "\" raised an exception");
}

double PythonTerm::evaluated(const Points& x, Sink& sink) const {
  const py::array_t<double> positions = shown(x);
  const py::object value = term_.attr("value")(positions);
  const double energy = PyFloat_AsDouble(value.ptr());
  if (PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    refuse("value() returned a " + std::string(py::str(py::type::of(value).attr("__name__"))) +
           "; expected a number [mJ]");
  }
  if (!std::isfinite(energy)) return std::isnan(energy) ? kNaN : kInfinity;
  if (sink.wants_gradient()) add_gradient(positions, sink);
  if (sink.wants_hessian()) add_hessian(positions, sink);
  return energy;
}

void PythonTerm::add_gradient(const py::array_t<double>& x, Sink& sink) const {
  const py::object given = term_.attr("gradient")(x);
  const py::array any = py::array::ensure(given);
  if (!any || !is_real(any) || any.ndim() != 2 || any.shape(0) != node_count_ || any.shape(1) != 3)
    refuse("gradient() returned " +
           (any ? "shape " + shape_of(any) + " of " + std::string(py::str(any.dtype()))
                : std::string("no array")) +
           "; expected numbers of shape (" + std::to_string(node_count_) + ", 3) [N]");
  const Dense gradient = Dense::ensure(any);
  const Eigen::Map<const Points> g(gradient.data(), 3, node_count_);
  for (int node = 0; node < node_count_; ++node) sink.add_gradient(node, g.col(node));
}

void PythonTerm::add_hessian(const py::array_t<double>& x, Sink& sink) const {
  if (!has_hessian_) {
    if (without_ == WithoutHessian::Zero) return;
    refuse(
        "has no hessian(), which this method needs; define it, or use a method that needs none: \"lbfgs\" or "
        "\"bfgs\"");
  }
  const py::object hessian = term_.attr("hessian")(x);
  if (py::hasattr(hessian, "tocsr") != is_sparse_)
    refuse("hessian() returned dense blocks once and a sparse matrix another time");
  if (is_sparse_)
    add_sparse(hessian, sink);
  else
    add_blocks(hessian, sink);
}

void PythonTerm::add_blocks(const py::object& given, Sink& sink) const {
  const py::array any = py::array::ensure(given);
  const int width = stencils_.width, size = 3 * width;
  if (!any || !is_real(any) || any.ndim() != 3 || any.shape(0) != stencils_.count() || any.shape(1) != size ||
      any.shape(2) != size)
    refuse("hessian() returned " +
           (any ? "shape " + shape_of(any) + " of " + std::string(py::str(any.dtype()))
                : std::string("no array")) +
           "; expected numbers of shape (" + std::to_string(stencils_.count()) + ", " + std::to_string(size) +
           ", " + std::to_string(size) + "), a block for each element [N/mm]");
  Dense blocks = Dense::ensure(any);
  if (sink.projection() == Projection::PositiveSemidefinite) blocks = projected(blocks);
  for (int e = 0; e < stencils_.count(); ++e) {
    const Eigen::Map<const ElementMatrix> h(blocks.data() + static_cast<long>(e) * size * size, size, size);
    for (int a = 0; a < width; ++a)
      for (int b = 0; b < width; ++b)
        sink.add_block(static_cast<long>(e) * width * width, width, a, b, h.block<3, 3>(3 * a, 3 * b));
  }
}

// --- a sparse matrix: every pair of coupled nodes is a stencil

py::object PythonTerm::csr_of(const py::object& matrix) const {
  const py::tuple shape = matrix.attr("shape");
  const auto wanted = 3 * node_count_;
  if (py::len(shape) != 2 || shape[0].cast<Eigen::Index>() != wanted ||
      shape[1].cast<Eigen::Index>() != wanted)
    refuse("hessian() returned a matrix of shape " + shape_of(matrix) + "; expected (" +
           std::to_string(wanted) + ", " + std::to_string(wanted) + "), coordinates node after node [N/mm]");
  return matrix.attr("tocsr")();
}

std::vector<PythonTerm::Pair> PythonTerm::pairs_in(const py::object& matrix) const {
  std::vector<Pair> pairs;
  for_each_entry(csr_of(matrix), [&](int row, int column, double) {
    if (row / 3 >= column / 3) pairs.emplace_back(row / 3, column / 3);
  });
  return pairs;
}

// With `elements` their nodes are coupled too.
void PythonTerm::couple_pairs(std::vector<Pair> pairs) {
  const auto width = static_cast<size_t>(stencils_.width);
  for (size_t first = 0; first < stencils_.nodes.size(); first += width)
    for (size_t a = 0; a < width; ++a)
      for (size_t b = 0; b <= a; ++b) {
        const int one = stencils_.nodes[first + a], other = stencils_.nodes[first + b];
        pairs.emplace_back(std::max(one, other), std::min(one, other));
      }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  pairs_ = std::move(pairs);
  stencils_ = {2, {}};
  for (const auto& [row, column] : pairs_) stencils_.nodes.insert(stencils_.nodes.end(), {row, column});
}

void PythonTerm::add_sparse(const py::object& matrix, Sink& sink) const {
  std::vector<Eigen::Matrix3d> blocks(pairs_.size(), Eigen::Matrix3d::Zero());
  for_each_entry(csr_of(matrix), [&](int row, int column, double value) {
    const Pair pair(row / 3, column / 3);
    if (pair.first < pair.second || value == 0) return;
    const auto found = std::lower_bound(pairs_.begin(), pairs_.end(), pair);
    if (found == pairs_.end() || *found != pair)
      refuse(
          "hessian() couples nodes " + std::to_string(pair.second) + " and " + std::to_string(pair.first) +
          ", which it did not at the reference positions; name them in `elements`, or store zeros for every "
          "pair that it may couple");
    blocks[static_cast<size_t>(found - pairs_.begin())](row % 3, column % 3) += value;
  });
  for (size_t k = 0; k < pairs_.size(); ++k) {
    const long place = 4 * static_cast<long>(k);
    const bool is_diagonal = pairs_[k].first == pairs_[k].second;
    sink.add_block(place, 2, 0, is_diagonal ? 0 : 1, blocks[k]);
    if (!is_diagonal) sink.add_block(place, 2, 1, 0, blocks[k].transpose());
  }
}

}  // namespace coapt::python
