// Boost.Python, and how a class of the plugin becomes a Python class.
#pragma once
#include <boost/python.hpp>
#include <boost/python/raw_function.hpp>
#include <boost/shared_ptr.hpp>
#include <stdexcept>
#include <string>

namespace yade {
namespace python {

	// YADE's objects are made from keywords only, except where a class takes its positional arguments itself (pyHandleCustomCtorArgs).
	template <class T> boost::shared_ptr<T> construct(boost::python::tuple positional, boost::python::dict named)
	{
		boost::shared_ptr<T> instance(new T);
		instance->pyHandleCustomCtorArgs(positional, named);
		if (boost::python::len(positional) > 0)
			throw std::runtime_error(instance->getClassName() + ": takes attributes by name only, " + instance->getClassName()
			        + "(attribute=value, ...)");
		if (boost::python::len(named) > 0) instance->pyUpdateAttrs(named);
		return instance;
	}

	template <class T> boost::python::object initialize(boost::python::tuple arguments, boost::python::dict named)
	{
		const boost::python::object constructor = boost::python::make_constructor(&construct<T>);
		return constructor(boost::python::object(arguments[0]), boost::python::tuple(arguments.slice(1, boost::python::_)), named);
	}

} // namespace python
} // namespace yade
