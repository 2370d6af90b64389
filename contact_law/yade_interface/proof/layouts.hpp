/* Do the declarations that this plugin was compiled with describe the YADE that runs? The C++ compiler cannot know: YADE ships no headers.
   So every member that the plugin relies on is written through Python and read in C++ at the offset that the declarations give it, then written in C++
   and read through Python, before YADE makes a single object of the plugin's classes. */
#pragma once
#include "member.hpp"
#include <string>
#include <vector>

namespace contact_law {
namespace proof {

	// The table of what is proven (members.cpp).
	std::vector<Member> members();

	// All functions below return an empty string, or one line that says what differs, where, and what to do.

	// Of the running YADE's version from the one that the declarations describe. Needs nothing but Python.
	std::string differenceInVersion();

	// Whether Python holds all classes that the following need (while YADE starts, they appear one by one).
	bool classesAreThere();

	// Of the orders of virtual functions; reads only (virtual_tables.cpp).
	std::string differenceInVirtualTables();

	// Of the members in the table. Uses objects made for the purpose.
	std::string differenceInMembers(const std::vector<Member>&);

	// Of the containers in a scene made for the purpose, and of the pointers in the running one, of which nothing is changed (scenes.cpp).
	std::string differenceInScenes();

	// All of the above, in an order in which nothing is touched that isn't proven.
	std::string differenceFromRunningYade();

	// The line.
	std::string refusal(const std::string& what, const std::string& where);

} // namespace proof
} // namespace contact_law
