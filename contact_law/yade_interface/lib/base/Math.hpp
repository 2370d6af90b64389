// Numbers and vectors as YADE has them: double precision, and Eigen without vectorisation or alignment.
// Eigen changes its layouts with these definitions, so they may neither be forgotten nor differ between files: State would be larger.
#pragma once
#if !defined(EIGEN_DONT_VECTORIZE) || !defined(EIGEN_DONT_ALIGN) || !defined(EIGEN_DISABLE_UNALIGNED_ARRAY_ASSERT)
#error "a file that sees a YADE type must be compiled with -DEIGEN_DONT_VECTORIZE -DEIGEN_DONT_ALIGN -DEIGEN_DISABLE_UNALIGNED_ARRAY_ASSERT"
#endif
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <boost/pointer_cast.hpp>
#include <boost/shared_ptr.hpp>
#include <boost/serialization/is_bitwise_serializable.hpp>
#include <boost/serialization/nvp.hpp>
#include <cmath>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

// As in YADE's header of this name.
#define YADE_CAST static_cast

namespace yade {

using boost::shared_ptr;
using std::string;

using Real = double;
using Vector3r = Eigen::Matrix<Real, 3, 1>;
using Vector3i = Eigen::Matrix<int, 3, 1>;
using Matrix3r = Eigen::Matrix<Real, 3, 3>;
using Quaternionr = Eigen::Quaternion<Real>;

template <class Scalar> struct Se3 {
	Eigen::Matrix<Scalar, 3, 1> position;
	Eigen::Quaternion<Scalar> orientation;
};
using Se3r = Se3<Real>;

} // namespace yade

// YADE marks it so; an archive written with another mark is not read back.
BOOST_IS_BITWISE_SERIALIZABLE(yade::Vector3r)

// The names become XML tags, and YADE's own libraries hold a function of the same name: it must do the same.
namespace boost {
namespace serialization {
	template <class Archive> void serialize(Archive& archive, yade::Vector3r& v, const unsigned int)
	{
		archive& make_nvp("x", v[0]);
		archive& make_nvp("y", v[1]);
		archive& make_nvp("z", v[2]);
	}
} // namespace serialization
} // namespace boost
