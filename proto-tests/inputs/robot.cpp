#include "proto-tests/inputs/robot.hpp"

namespace liloc::inputs {

Result<std::unique_ptr<Robot>> Robot::start(const std::vector<std::string>& arguments) {
  std::vector<const char*> given{"liloc-client"};
  for (const std::string& argument : arguments) given.push_back(argument.c_str());
  int exit_code = 0;
  auto options = parse_arguments(static_cast<int>(given.size()), given.data(), exit_code);
  if (!options) return tl::unexpected(options.error());
  if (!options->device_file.empty())
    if (const Status read = read_device_file(*options); !read) return tl::unexpected(read.error());
  std::unique_ptr<Robot> robot(new Robot(std::move(*options)));
  if (const Status opened = robot->open(); !opened) return tl::unexpected(opened.error());
  return robot;
}

Status Robot::open() {
  auto seat = wire::Participant::create({.domain = options_.client.domain});
  if (!seat) return tl::unexpected(seat.error());
  seat_ = std::move(*seat);
  auto made = client::Client::create(options_.client);
  if (!made) return fail("{}", made.error());
  client_ = std::move(made.value());
  auto dispatcher = wire::Dispatcher::create(*seat_);
  if (!dispatcher) return tl::unexpected(dispatcher.error());
  sensors_ = std::move(*dispatcher);
  feed_ = std::make_unique<SensorFeed>(options_, *client_);
  if (Status subscribed = feed_->subscribe(*sensors_); !subscribed) return subscribed;
  sensors_->start();
  return {};
}

Robot::~Robot() {
  if (sensors_) sensors_->stop();
}

}  // namespace liloc::inputs
