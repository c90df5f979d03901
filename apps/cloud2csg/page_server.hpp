#pragma once

#include <functional>
#include <stop_token>
#include <string>

namespace cloud2csg::app {

/// Serves one page at http://127.0.0.1:`port`/ (0: any free port) until the stop. Listens on the loopback address only
/// and refuses requests for another host (status 403), so that no foreign page can reach it by DNS rebinding. Serves
/// nothing else. `on_ready` gets the address. @throws Error when the port is unavailable.
void serve_page(const std::string& page, int port, const std::stop_token& stop,
                const std::function<void(const std::string& address)>& on_ready);

/// Opens an address with xdg-open. False without a desktop or xdg-open, or when it fails within a second.
bool open_in_browser(const std::string& address);

}  // namespace cloud2csg::app
