// Numbers and vectors as YADE has them: double precision, and Eigen without vectorisation or alignment.
// Eigen changes its layouts with these definitions, so they may neither be forgotten nor differ between files: State would be larger.
#pragma once
#if !defined(EIGEN_DONT_VECTORIZE) || !defined(EIGEN_DONT_ALIGN) || !defined(EIGEN_DISABLE_UNALIGNED_ARRAY_ASSERT)
#error "a file that sees a YADE type must be compiled with -DEIGEN_DONT_VECTORIZE -DEIGEN_DONT_ALIGN -DEIGEN_DISABLE_UNALIGNED_ARRAY_ASSERT"
#endif
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <boost/lexical_cast.hpp>
#include <boost/pointer_cast.hpp>
#include <boost/shared_ptr.hpp>
#include <boost/serialization/is_bitwise_serializable.hpp>
#include <boost/serialization/nvp.hpp>
#include <cmath>
#include <iostream>
#include <limits>
#include <list>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

// What YADE's header of this name brings beside the numbers, and sources in its idiom rely on.
#define YADE_CAST static_cast
#define YADE_PTR_CAST ::boost::static_pointer_cast
#define YADE_PTR_DYN_CAST ::boost::dynamic_pointer_cast

namespace yade {

using boost::shared_ptr;
using std::cerr;
using std::cout;
using std::endl;
using std::invalid_argument;
using std::logic_error;
using std::pair;
using std::runtime_error;
using std::string;
using std::vector;

using Real = double;
using Vector2r = Eigen::Matrix<Real, 2, 1>;
using Vector3r = Eigen::Matrix<Real, 3, 1>;
using Vector3i = Eigen::Matrix<int, 3, 1>;
using Matrix3r = Eigen::Matrix<Real, 3, 3>;
using Quaternionr = Eigen::Quaternion<Real>;
using AngleAxisr = Eigen::AngleAxis<Real>;

template <class Scalar> struct Se3 {
	Eigen::Matrix<Scalar, 3, 1> position;
	Eigen::Quaternion<Scalar> orientation;
};
using Se3r = Se3<Real>;

const Real NaN = std::numeric_limits<Real>::quiet_NaN();

} // namespace yade

// YADE marks these types so; an archive written with other marks is not read back.
BOOST_IS_BITWISE_SERIALIZABLE(yade::Vector2r)
BOOST_IS_BITWISE_SERIALIZABLE(yade::Vector3r)
BOOST_IS_BITWISE_SERIALIZABLE(yade::Vector3i)
BOOST_IS_BITWISE_SERIALIZABLE(yade::Matrix3r)
BOOST_IS_BITWISE_SERIALIZABLE(yade::Quaternionr)

// The names become XML tags, and YADE's own libraries hold functions of the same names: they must do the same.
namespace boost {
namespace serialization {
	template <class Archive> void serialize(Archive& archive, yade::Vector2r& v, const unsigned int)
	{
		archive& make_nvp("x", v[0]);
		archive& make_nvp("y", v[1]);
	}
	template <class Archive> void serialize(Archive& archive, yade::Vector3r& v, const unsigned int)
	{
		archive& make_nvp("x", v[0]);
		archive& make_nvp("y", v[1]);
		archive& make_nvp("z", v[2]);
	}
	template <class Archive> void serialize(Archive& archive, yade::Vector3i& v, const unsigned int)
	{
		archive& make_nvp("x", v[0]);
		archive& make_nvp("y", v[1]);
		archive& make_nvp("z", v[2]);
	}
	template <class Archive> void serialize(Archive& archive, yade::Quaternionr& q, const unsigned int)
	{
		archive& make_nvp("w", q.w());
		archive& make_nvp("x", q.x());
		archive& make_nvp("y", q.y());
		archive& make_nvp("z", q.z());
	}
	template <class Archive> void serialize(Archive& archive, yade::Matrix3r& m, const unsigned int)
	{
		static const char* const tags[] = { "m00", "m01", "m02", "m10", "m11", "m12", "m20", "m21", "m22" };
		for (int i = 0; i < 9; ++i)
			archive& make_nvp(tags[i], m(i / 3, i % 3));
	}
} // namespace serialization
} // namespace boost
