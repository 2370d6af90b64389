// Vectors of YADE as the kernel's, and back.
#pragma once
#include "../kernel/numbers.hpp"
#include <lib/base/Math.hpp>

namespace yade {

inline contact_law::Vec3<double> toKernel(const Vector3r& v) { return { v[0], v[1], v[2] }; }
inline Vector3r fromKernel(const contact_law::Vec3<double>& v) { return Vector3r(v.x, v.y, v.z); }

} // namespace yade
