// The one object of a class. instance() is exported by libyade for ClassFactory and Omega, hence no body here.
#pragma once
// global, not in namespace yade: its mangled name says so
template <class T> class Singleton {
public:
	static T& instance();
};
