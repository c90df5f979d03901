#pragma once

#include <functional>
#include <stop_token>
#include <string>

namespace cloud2csg::app {

/// Serves one page at http://127.0.0.1:`port`/ (0: any free port) until the stop, to this machine only: it listens on
/// the loopback address, and refuses requests that name another host (status 403), as a page of a stranger would
/// through a name that resolves to this machine. Nothing else is served. `on_ready` gets the address.
/// @throws Error when the port cannot be had.
void serve_page(const std::string& page, int port, const std::stop_token& stop,
                const std::function<void(const std::string& address)>& on_ready);

/// Opens an address with xdg-open, where there is a desktop and that program; false where there is not, or it fails
/// within a second. Waits no longer.
bool open_in_browser(const std::string& address);

}  // namespace cloud2csg::app
