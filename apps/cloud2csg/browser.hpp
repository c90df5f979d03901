#pragma once

#include <string>

namespace cloud2csg::app {

/// Opens an address with xdg-open, where there is a desktop and that program; false where there is not, or it fails
/// within a second. Waits no longer.
bool open_in_browser(const std::string& address);

}  // namespace cloud2csg::app
