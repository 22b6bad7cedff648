// base/function_ref.h - a non-owning reference to anything callable: two pointers, no allocation.
//
// Invariants: valid only while the callable lives; meant for parameters, never for members.
// Thread safety: as safe as the callable itself.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>

namespace strahl {

template <class Signature>
class function_ref;

/// Refers to a callable `R(Args...)` without owning or copying it. Take it by value as a parameter.
template <class R, class... Args>
class function_ref<R(Args...)> {
 public:
  /// Binds to `callable`, which must outlive this object (a temporary lives to the end of the
  /// call).
  template <class F>
  requires(!std::is_same_v<std::remove_cvref_t<F>, function_ref> &&
           std::is_invocable_r_v<R, F&, Args...>) function_ref(F&& callable)
  noexcept  // implicit on purpose: call sites pass lambdas
  {
    using Callable = std::remove_reference_t<F>;
    if constexpr (std::is_function_v<Callable>) {
      target_.function = reinterpret_cast<void (*)()>(&callable);
      call_ = [](Target target, Args... args) -> R {
        return reinterpret_cast<Callable*>(target.function)(std::forward<Args>(args)...);
      };
    } else {
      target_.object = const_cast<void*>(static_cast<const void*>(std::addressof(callable)));
      call_ = [](Target target, Args... args) -> R {
        return (*static_cast<Callable*>(target.object))(std::forward<Args>(args)...);
      };
    }
  }

  R operator()(Args... args) const { return call_(target_, std::forward<Args>(args)...); }

 private:
  // Functions and objects may differ in pointer size, so each has its own member.
  union Target {
    void* object;
    void (*function)();
  };

  Target target_;
  R (*call_)(Target, Args...);
};

}  // namespace strahl
