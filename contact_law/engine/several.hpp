// Several packs side by side as one number, with what the kernel needs of a number type (kernel/numbers.hpp): while one of them waits for a result,
// the others go on.
#pragma once
#include "../kernel/numbers.hpp"

namespace contact_law {

template <class Pack, int count> struct Several {
	Pack part[count];

	Several() = default;
	Several(double x)
	{
		for (Pack& one : part)
			one = Pack(x);
	}
	template <class Of> static Several each(Of&& of) // of(k): part k
	{
		Several all;
		for (int k = 0; k < count; ++k)
			all.part[k] = of(k);
		return all;
	}
};
template <class Pack, int count> struct SeveralMasks {
	MaskOf<Pack> part[count];
};

template <class P, int n> inline Several<P, n> operator+(const Several<P, n>& a, const Several<P, n>& b)
{
	return Several<P, n>::each([&](int k) { return a.part[k] + b.part[k]; });
}
template <class P, int n> inline Several<P, n> operator-(const Several<P, n>& a, const Several<P, n>& b)
{
	return Several<P, n>::each([&](int k) { return a.part[k] - b.part[k]; });
}
template <class P, int n> inline Several<P, n> operator*(const Several<P, n>& a, const Several<P, n>& b)
{
	return Several<P, n>::each([&](int k) { return a.part[k] * b.part[k]; });
}
template <class P, int n> inline Several<P, n> operator/(const Several<P, n>& a, const Several<P, n>& b)
{
	return Several<P, n>::each([&](int k) { return a.part[k] / b.part[k]; });
}
template <class P, int n> inline Several<P, n> operator-(const Several<P, n>& a)
{
	return Several<P, n>::each([&](int k) { return -a.part[k]; });
}
template <class P, int n> inline Several<P, n> root(const Several<P, n>& a)
{
	return Several<P, n>::each([&](int k) { return root(a.part[k]); });
}

template <class P, int n> inline SeveralMasks<P, n> operator<(const Several<P, n>& a, const Several<P, n>& b)
{
	SeveralMasks<P, n> all;
	for (int k = 0; k < n; ++k)
		all.part[k] = a.part[k] < b.part[k];
	return all;
}
template <class P, int n> inline bool anyOf(const SeveralMasks<P, n>& masks)
{
	bool any = false;
	for (const auto& one : masks.part)
		any |= anyOf(one);
	return any;
}
template <class P, int n> inline Several<P, n> choose(const SeveralMasks<P, n>& m, const Several<P, n>& yes, const Several<P, n>& no)
{
	return Several<P, n>::each([&](int k) { return choose(m.part[k], yes.part[k], no.part[k]); });
}

} // namespace contact_law
