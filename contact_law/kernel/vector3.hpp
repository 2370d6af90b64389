// Three numbers with the operations the contact law needs.
#pragma once

namespace contact_law {

template <class T> struct Vec3 {
	T x, y, z;
};

template <class T> inline Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) { return { a.x + b.x, a.y + b.y, a.z + b.z }; }
template <class T> inline Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) { return { a.x - b.x, a.y - b.y, a.z - b.z }; }
template <class T> inline Vec3<T> operator-(const Vec3<T>& a) { return { -a.x, -a.y, -a.z }; }
template <class T> inline Vec3<T> operator*(const T& s, const Vec3<T>& a) { return { s * a.x, s * a.y, s * a.z }; }
template <class T> inline T dot(const Vec3<T>& a, const Vec3<T>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> inline Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b)
{
	return { a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}

} // namespace contact_law
