// The module liloc._liloc: names, arguments and texts; what they do lies in python_client.cpp and arrays.cpp.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "client/python/python_client.hpp"

namespace liloc::client::python {
namespace {

using namespace pybind11::literals;

py::object matrix_or_none(const std::optional<Pose>& pose) {
  return pose ? py::object(to_matrix(*pose)) : py::none();
}

Local local_of(const std::string& name) {
  if (name == "cloud") return Local::cloud;
  if (name == "inertial") return Local::inertial;
  if (name == "dead_reckoning") return Local::dead_reckoning;
  if (name == "external") return Local::external;
  throw py::value_error("local is '" + name + "'; must be 'cloud', 'inertial', 'dead_reckoning' or 'external'");
}

Codec codec_of(const std::string& name) {
  if (name == "draco") return Codec::draco;
  if (name == "voxel") return Codec::voxel;
  if (name == "octree") return Codec::octree;
  throw py::value_error("codec is '" + name + "'; must be 'draco', 'voxel' or 'octree'");
}

std::string text_of(const PoseUpdate& update) {
  const char* const states[] = {"SEARCHING", "TRACKING", "COASTING", "LOST"};
  return "<liloc.PoseUpdate of " + std::to_string(update.stamp_ns) + " ns, " +
         states[static_cast<int>(update.state)] + (update.T_map_sensor ? ", located>" : ", not located>");
}

void declare_values(py::module_& module) {
  py::class_<Camera>(module, "Camera")
      .def(py::init([](int width, int height, double fx, double fy, double cx, double cy,
                       double depth_scale_m) { return Camera{width, height, fx, fy, cx, cy, depth_scale_m}; }),
           "width"_a, "height"_a, "fx"_a, "fy"_a, "cx"_a, "cy"_a, "depth_scale_m"_a = Camera{}.depth_scale_m)
      .def_readwrite("width", &Camera::width)
      .def_readwrite("height", &Camera::height)
      .def_readwrite("fx", &Camera::fx)
      .def_readwrite("fy", &Camera::fy)
      .def_readwrite("cx", &Camera::cx)
      .def_readwrite("cy", &Camera::cy)
      .def_readwrite("depth_scale_m", &Camera::depth_scale_m);
  py::enum_<State>(module, "State")
      .value("SEARCHING", State::searching)
      .value("TRACKING", State::tracking)
      .value("COASTING", State::coasting)
      .value("LOST", State::lost);
  py::class_<Stats>(module, "Stats")
      .def_readonly("frames", &Stats::frames)
      .def_readonly("frames_dropped", &Stats::frames_dropped)
      .def_readonly("frames_refused", &Stats::frames_refused)
      .def_readonly("frames_uninformative", &Stats::frames_uninformative)
      .def_readonly("imu_refused", &Stats::imu_refused)
      .def_readonly("requests", &Stats::requests)
      .def_readonly("requests_unsent", &Stats::requests_unsent)
      .def_readonly("requests_unanswered", &Stats::requests_unanswered)
      .def_readonly("replies", &Stats::replies)
      .def_readonly("replies_verified", &Stats::replies_verified)
      .def_readonly("replies_refused", &Stats::replies_refused)
      .def_readonly("frame_ms_median", &Stats::frame_ms_median)
      .def_readonly("frame_ms_p99", &Stats::frame_ms_p99)
      .def_readonly("frames_skipped", &Stats::frames_skipped)
      .def_readonly("odometry_refused", &Stats::odometry_refused)
      .def_readonly("cpu_s", &Stats::cpu_s)
      .def_readonly("clock_offset_ms", &Stats::clock_offset_ms)
      .def_readonly("clock_round_trip_ms", &Stats::clock_round_trip_ms)
      .def_readonly("clock_good", &Stats::clock_good)
      .def_readonly("clock_jumps", &Stats::clock_jumps)
      .def_readonly("problem", &Stats::problem)
      .def_readonly("localized_s", &Stats::localized_s);
}

void declare_answers(py::module_& module) {
  py::class_<PoseUpdate>(module, "PoseUpdate")
      .def_readonly("stamp_ns", &PoseUpdate::stamp_ns)
      .def_property_readonly("T_map_sensor", [](const PoseUpdate& u) { return matrix_or_none(u.T_map_sensor); })
      .def_property_readonly("T_odom_sensor", [](const PoseUpdate& u) { return to_matrix(u.T_odom_sensor); })
      .def_readonly("odom_segment", &PoseUpdate::odom_segment)
      .def_readonly("informative", &PoseUpdate::informative)
      .def_readonly("converged", &PoseUpdate::converged)
      .def_readonly("state", &PoseUpdate::state)
      .def_readonly("server_connected", &PoseUpdate::server_connected)
      .def_property_readonly("observed",
                             [](const PoseUpdate& u) { return py::array_t<double>(6, u.observed.data()); })
      .def_property_readonly("covariance",
                             [](const PoseUpdate& u) {
                               return py::array_t<double>({6, 6}, u.covariance.data());
                             })
      .def("__repr__", &text_of);
  py::class_<Reply>(module, "Reply")
      .def_readonly("stamp_ns", &Reply::stamp_ns)
      .def_readonly("verified", &Reply::verified)
      .def_readonly("status", &Reply::status)
      .def_readonly("reason", &Reply::reason)
      .def_readonly("text", &Reply::text)
      .def_property_readonly("T_map_sensor", [](const Reply& r) { return matrix_or_none(r.T_map_sensor); })
      .def_property_readonly("covariance",
                             [](const Reply& r) {
                               return py::array_t<double>({6, 6}, r.covariance.data());
                             })
      .def_readonly("latency_ms", &Reply::latency_ms)
      .def_readonly("confidence", &Reply::confidence)
      .def_readonly("advice", &Reply::advice);
}

std::shared_ptr<PythonClient> make_client(Options options, const std::string& local, const std::string& codec,
                                          const py::object& T_imu_sensor, const py::object& T_base_sensor,
                                          const py::object& on_pose, const py::object& on_reply) {
  options.local = local_of(local);
  options.codec = codec_of(codec);
  if (!T_imu_sensor.is_none()) options.T_imu_sensor = from_matrix(T_imu_sensor, "T_imu_sensor");
  if (!T_base_sensor.is_none()) options.T_base_sensor = from_matrix(T_base_sensor, "T_base_sensor");
  auto client = std::make_shared<PythonClient>(options, callback_of(on_pose, "on_pose"),
                                               callback_of(on_reply, "on_reply"));
  stop_at_exit(client);
  return client;
}

void declare_client(py::module_& module) {
  const Options d;
  py::class_<PythonClient, std::shared_ptr<PythonClient>>(module, "Client")
      .def(py::init([](std::string id, const Camera& camera, int domain, std::string network_interface,
                       std::vector<std::string> peers, double min_range_m, double max_range_m,
                       double voxel_size_m, int interval_ms, int reply_timeout_ms, const std::string& local,
                       const py::object& T_imu_sensor, double still_seconds, bool cold, std::uint64_t seed,
                       std::size_t queue_frames, std::string trace_folder, const py::object& T_base_sensor,
                       double cpu_share, bool submap, std::size_t request_bytes, int searching_interval_ms,
                       double lost_sd_m, double lost_sd_deg, const std::string& codec, std::string credentials,
                       const py::object& on_pose, const py::object& on_reply) {
             Options o;
             o.id = std::move(id);
             o.camera = camera;
             o.domain = domain;
             o.network_interface = std::move(network_interface);
             o.peers = std::move(peers);
             o.min_range_m = min_range_m;
             o.max_range_m = max_range_m;
             o.voxel_size_m = voxel_size_m;
             o.interval_ms = interval_ms;
             o.reply_timeout_ms = reply_timeout_ms;
             o.still_seconds = still_seconds;
             o.cold = cold;
             o.seed = seed;
             o.queue_frames = queue_frames;
             o.trace_folder = std::move(trace_folder);
             o.cpu_share = cpu_share;
             o.submap = submap;
             o.request_bytes = request_bytes;
             o.searching_interval_ms = searching_interval_ms;
             o.lost_sd_m = lost_sd_m;
             o.lost_sd_deg = lost_sd_deg;
             o.credentials = std::move(credentials);
             return make_client(std::move(o), local, codec, T_imu_sensor, T_base_sensor, on_pose, on_reply);
           }),
           "id"_a, "camera"_a, py::kw_only(), "domain"_a = d.domain,
           "network_interface"_a = d.network_interface, "peers"_a = d.peers, "min_range_m"_a = d.min_range_m,
           "max_range_m"_a = d.max_range_m, "voxel_size_m"_a = d.voxel_size_m, "interval_ms"_a = d.interval_ms,
           "reply_timeout_ms"_a = d.reply_timeout_ms, "local"_a = "cloud", "T_imu_sensor"_a = py::none(),
           "still_seconds"_a = d.still_seconds, "cold"_a = d.cold, "seed"_a = d.seed,
           "queue_frames"_a = d.queue_frames, "trace_folder"_a = d.trace_folder, "T_base_sensor"_a = py::none(),
           "cpu_share"_a = d.cpu_share, "submap"_a = d.submap, "request_bytes"_a = d.request_bytes,
           "searching_interval_ms"_a = d.searching_interval_ms, "lost_sd_m"_a = d.lost_sd_m,
           "lost_sd_deg"_a = d.lost_sd_deg, "codec"_a = "draco", "credentials"_a = d.credentials,
           "on_pose"_a = py::none(), "on_reply"_a = py::none())
      .def("push_depth", &PythonClient::push_depth, "depth"_a, "stamp_ns"_a)
      .def("push_imu", &PythonClient::push_imu, "stamps_ns"_a, "samples"_a)
      .def("push_points", &PythonClient::push_points, "points"_a, "stamp_ns"_a)
      .def("push_odometry", &PythonClient::push_odometry, "stamp_ns"_a, "T_odom_base"_a,
           "covariance"_a = py::none())
      .def("newest", &PythonClient::newest)
      .def("wait", &PythonClient::wait, "newer_than_ns"_a = 0, "timeout_s"_a = 1.0)
      .def("stats", &PythonClient::stats)
      .def("stop", &PythonClient::stop)
      .def("__enter__", [](const std::shared_ptr<PythonClient>& self) { return self; })
      .def("__exit__", [](PythonClient& self, const py::args& /*error*/) { self.stop(); });
}

}  // namespace
}  // namespace liloc::client::python

PYBIND11_MODULE(_liloc, module) {
  using namespace liloc::client::python;
  py::register_exception<ClientError>(module, "Error", PyExc_RuntimeError).attr("__module__") = "liloc";
  declare_values(module);
  declare_answers(module);
  declare_client(module);
  module.def("set_log", &set_python_log, py::arg("callback"));
  module.attr("__version__") = LILOC_VERSION;
  py::module_::import("atexit").attr("register")(py::cpp_function(&stop_all));
}
