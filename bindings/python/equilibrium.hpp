// A scene that is followed while parameters change, and figures of merit of it, as Python holds them.
#pragma once

#include "core/error.hpp"
#include "module.hpp"
#include "tuning/tracked_scene.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace coapt::python {

// Python sees positions in the coordinates of the input: the model's, moved by its origin. One call at a
// time; a second one, from another thread or from a metric of the caller's, is refused. All members under the
// interpreter lock but for the work of at_work().
class Followed {
 public:
  Scene scene;
  Failure failure;  // before `tracked`, whose observer and terms refer to it
  TrackedScene tracked;

  Followed() = default;
  Followed(const Followed&) = delete;
  Followed& operator=(const Followed&) = delete;

  // Runs work() without the interpreter lock; what the caller's code raised in it, and Ctrl-C, are raised.
  template <typename Work>
  std::invoke_result_t<Work> at_work(const Work& work) {
    require_idle();
    const Busy busy(is_busy_);
    return failure.guarding(work);
  }

  // Throws InputError while a call is at work.
  void require_idle() const {
    if (is_busy_)
      throw InputError(
          "equilibrium: another call is at work on it; one object serves one thread at a time, and a metric "
          "or "
          "a term written in Python cannot call it");
  }

  TrackedEquilibrium& equilibrium() { return *tracked.equilibrium; }
  const Vec3& origin() const { return tracked.model.origin; }

  void add(const std::vector<std::string>& names);  // those that are sound; throws InputError for the others
  const Vector& value() const { return value_; }
  void set(const Vector& value);
  void resume(const Vector& value, const Points& x);  // TrackedEquilibrium::resume_at(), as Python sees them
  py::array_t<double> shape();  // positions, (n, 3), read-only; kept by the array, whatever comes after
  void keep_shape();            // of the present; without the lock

 private:
  void add(std::unique_ptr<Parameter> parameter);
  Vector own(const Vector& value);  // numbers in the model's coordinates

  struct Busy {
    explicit Busy(bool& flag) : is_busy(flag) { is_busy = true; }
    ~Busy() { is_busy = false; }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;
    bool& is_busy;
  };

  bool is_busy_ = false;
  Vector value_, offset_;  // in the coordinates of the input, and what that adds to the model's
  std::shared_ptr<const Points> shape_;
};

// A metric, with the scene that it looks into. offset: of its value, between the two origins.
struct FigureOfMerit {
  std::shared_ptr<Followed> of;
  std::unique_ptr<Metric> metric;
  double offset = 0;
};

void define_derivatives(py::class_<Followed, std::shared_ptr<Followed>>& type);
void define_metrics(py::module_& module);

// (term, element, before, after, is_kink) of each.
py::list switch_list(const std::vector<Switch>& switches);

}  // namespace coapt::python
