/* The call operator of functors: go with one to seven arguments and its reverse, of which the final class overrides one. Slots past the functor's own
   arguments take boost::mpl::void_. Order and number of the virtual functions are those of YADE's tables. */
#pragma once
#include <boost/mpl/at.hpp>
#include <boost/mpl/if.hpp>
#include <boost/mpl/int.hpp>
#include <boost/mpl/less.hpp>
#include <boost/mpl/size.hpp>
#include <boost/mpl/vector.hpp>
#include <boost/mpl/void.hpp>
#include <stdexcept>
#include <string>

namespace yade {

template <class Result, class Arguments> class FunctorWrapper {
	template <int i, bool inside = (i < boost::mpl::size<Arguments>::value)> struct At {
		using type = boost::mpl::void_;
	};
	template <int i> struct At<i, true> {
		using type = typename boost::mpl::at_c<Arguments, i>::type;
	};
	using A1 = typename At<0>::type;
	using A2 = typename At<1>::type;
	using A3 = typename At<2>::type;
	using A4 = typename At<3>::type;
	using A5 = typename At<4>::type;
	using A6 = typename At<5>::type;
	using A7 = typename At<6>::type;

	[[noreturn]] static Result notOverridden()
	{
		throw std::logic_error("a functor was called with a number of arguments that it does not take");
	}

public:
	virtual ~FunctorWrapper() {}
	virtual std::string checkOrder() const { return ""; }
	virtual Result go(A1) { return notOverridden(); }
	virtual Result go(A1, A2) { return notOverridden(); }
	virtual Result go(A1, A2, A3) { return notOverridden(); }
	virtual Result go(A1, A2, A3, A4) { return notOverridden(); }
	virtual Result go(A1, A2, A3, A4, A5) { return notOverridden(); }
	virtual Result go(A1, A2, A3, A4, A5, A6) { return notOverridden(); }
	virtual Result go(A1, A2, A3, A4, A5, A6, A7) { return notOverridden(); }
	virtual Result goReverse(A1) { return notOverridden(); }
	virtual Result goReverse(A1, A2) { return notOverridden(); }
	virtual Result goReverse(A1, A2, A3) { return notOverridden(); }
	virtual Result goReverse(A1, A2, A3, A4) { return notOverridden(); }
	virtual Result goReverse(A1, A2, A3, A4, A5) { return notOverridden(); }
	virtual Result goReverse(A1, A2, A3, A4, A5, A6) { return notOverridden(); }
	virtual Result goReverse(A1, A2, A3, A4, A5, A6, A7) { return notOverridden(); }
};

} // namespace yade
