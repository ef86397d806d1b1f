#ifndef LILOC_CLIENT_H
#define LILOC_CLIENT_H
/* LiLoc for a robot, in C99: push depth frames and, where there is an IMU, its samples; read the pose.
 *
 *   liloc_client_options options;
 *   liloc_client* client = NULL;
 *   liloc_client_options_init(&options, sizeof options);
 *   options.id = "robot1";
 *   options.camera = (liloc_camera){640, 480, 460.0, 460.0, 319.5, 239.5, 0.00025};
 *   if (liloc_client_create(&options, sizeof options, &client) || liloc_client_start(client)) {
 *     puts(liloc_client_last_error());
 *     return 1;
 *   }
 *   liloc_pose_update now;
 *   liloc_client_push_depth(client, units, 640, 480, stamp_ns);  // from the driver: returns at once
 *   liloc_client_newest(client, &now, sizeof now);
 *   if (now.has_map) drive(&now.T_map_sensor);
 *   liloc_client_destroy(client);
 *
 * Metres and radians; stamps are nanoseconds of the device's clock. Optical frame: x right, y down, z forward.
 * Poses: p_to = T_to_from * p_from.
 *
 * Errors. Every call that can fail returns a liloc_status and, if it is not LILOC_OK, changed nothing;
 * liloc_client_last_error() then tells the calling thread what was wrong and how to mend it. Wrong use is such
 * an error too: nothing here aborts, prints or throws.
 *
 * Threads. Every call may come from any thread, and none waits for the network. liloc_client_destroy must be
 * the last call with its handle. Callbacks run on the client's own threads (see each); from inside a callback,
 * liloc_client_start, _stop and _destroy are refused with LILOC_WRONG_STATE.
 *
 * Growth. Structures are passed with their size, new fields go last and statuses are never renumbered, so that
 * a program goes on working with a newer library of the same SONAME. */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum liloc_status {
  LILOC_OK = 0,
  LILOC_INVALID_ARGUMENT = 1, /* a null pointer, a wrong size, an option or a value out of its range */
  LILOC_WRONG_STATE = 2,      /* not started yet, started already, stopped, or called from inside a callback */
  LILOC_FAILED = 3,           /* the network or the file system said no: the text carries what it said */
  LILOC_OUT_OF_MEMORY = 4,
  LILOC_INTERNAL = 5 /* a fault of the library: please report it with the text */
} liloc_status;

typedef enum liloc_local {
  LILOC_LOCAL_CLOUD = 0,    /* clouds, helped by the IMU where there is one */
  LILOC_LOCAL_INERTIAL = 1, /* these two need has_imu */
  LILOC_LOCAL_DEAD_RECKONING = 2,
  LILOC_LOCAL_EXTERNAL = 3 /* the odometry is somebody else's: liloc_client_push_odometry */
} liloc_local;

/* How a request's clouds travel: draco, 7 to 8 kB a frame at 1.5 mm RMSE; voxel, for thin links, 5 to 7 kB
 * at 1.5 mm; octree, for comparison, 7 to 8 kB at 5 to 11 mm. A server that does not read it gets another that
 * it does. */
typedef enum liloc_codec { LILOC_CODEC_DRACO = 1, LILOC_CODEC_OCTREE = 2, LILOC_CODEC_VOXEL = 3 } liloc_codec;

typedef enum liloc_state {
  LILOC_SEARCHING = 0, /* never located */
  LILOC_TRACKING = 1,  /* located, the server answers */
  LILOC_COASTING = 2,  /* located once, and carried on by the device alone */
  LILOC_LOST = 3       /* located once, but the pose may be off by more than lost_sd_m, lost_sd_deg allow */
} liloc_state;

typedef enum liloc_log_level {
  LILOC_LOG_DEBUG = 0,
  LILOC_LOG_INFO = 1,
  LILOC_LOG_WARNING = 2,
  LILOC_LOG_ERROR = 3
} liloc_log_level;

typedef struct liloc_camera {
  int32_t width, height;
  double fx, fy, cx, cy;
  double depth_scale_m; /* metres per unit of a depth image */
} liloc_camera;

typedef struct liloc_pose {
  double translation_m[3];
  double rotation_xyzw[4];
} liloc_pose;

/* Filled by liloc_client_options_init with defaults that work in an office; id and camera have none. */
typedef struct liloc_client_options {
  const char* id; /* 1..63 of [A-Za-z0-9_-]; one run at a time per id */
  liloc_camera camera;
  int32_t domain;                /* DDS domain, 0..230 */
  const char* network_interface; /* name, address or "auto"; "lo" reaches a server on this host */
  const char* const* peers;      /* hosts of the server; NULL: this host */
  size_t peer_count;
  double min_range_m, max_range_m;
  double voxel_size_m;      /* 0.01..0.5 */
  int32_t interval_ms;      /* upper bound between global registrations, 50..60000 */
  int32_t reply_timeout_ms; /* a request without an answer for so long counts as unanswered; 100 or more */
  int32_t local;            /* liloc_local */
  bool has_imu;             /* T_imu_sensor is set, and liloc_client_push_imu takes samples */
  liloc_pose T_imu_sensor;
  double still_seconds; /* the device stands still for so long at the start (IMU calibration) */
  bool cold;            /* each request is answered on its own: no prior, no history */
  uint64_t seed;
  size_t queue_frames;      /* depth frames that may wait; the oldest is dropped for the newest */
  const char* trace_folder; /* online.tum, trajectory.tum, spots.csv, local.csv; NULL: none */
  bool has_base;            /* T_base_sensor is set */
  liloc_pose T_base_sensor; /* with external odometry: the sensor on what the odometry moves */
  double cpu_share;         /* of one core, 0.02..1; frames are left out to keep it */
  bool submap;              /* requests carry what stands around as well, unless `cold` */
  uint64_t
      request_bytes; /* most, of a request's clouds, 2000..60000; 0: 15000. The surroundings give way first */
  /* Lower bound between global registrations while nothing is verified, 0..60000; 0: a quarter of interval_ms.
   * An answer then brings the next request forward; not under interval_ms: it does not. */
  int32_t searching_interval_ms;
  /* Standard deviations of the pose beyond which the state is LILOC_LOST, 0.01..100 m and 0.1..180 degrees; 0:
   * 0.3 and 10, which the method's paper counts as a wrong pose. */
  double lost_sd_m, lost_sd_deg;
  int32_t codec; /* liloc_codec; 0: draco */
  /* Folder of deploy/credentials for this id, at a locked site: traffic is encrypted, and only with those who
   * have theirs of the same keystore. NULL: none. */
  const char* credentials;
} liloc_client_options;

typedef struct liloc_pose_update {
  int64_t stamp_ns; /* of the frame; 0 before the first */
  bool has_map;     /* an answer was verified: T_map_sensor holds */
  liloc_pose T_map_sensor;
  liloc_pose T_odom_sensor; /* smooth; corrections do not move it (REP-105) */
  uint32_t odom_segment;    /* rises when the odometry broke */
  bool informative;         /* the frame showed enough to be matched */
  bool converged;           /* its pose was measured, and continues the one before */
  int32_t state;            /* liloc_state */
  bool server_connected;
  /* Share of a motion along each axis of the sensor that the frame showed, [rotation; translation], 0..1:
   * beside a bare wall it is near 0 along the wall, and the pose follows the prediction there. All 0 for a
   * guess, and with LILOC_LOCAL_EXTERNAL. */
  double observed[6];
  /* Of T_map_sensor, row-major, sensor frame, [rad; m]: that of the last verified answer, carried on by what
   * the odometry may have erred since. All 0 without has_map. */
  double covariance[36];
} liloc_pose_update;

/* Its texts live as long as the callback. */
typedef struct liloc_reply {
  int64_t stamp_ns; /* of the frame that was asked about */
  bool verified;
  const char *status, *reason; /* as in spots.csv */
  const char* text;            /* for people */
  bool has_map;                /* the server had a best answer for that frame */
  liloc_pose T_map_sensor;
  double covariance[36]; /* of T_map_sensor, row-major, sensor frame, [rad; m] */
  double latency_ms;     /* on the server */
  double confidence;     /* probability that T_map_sensor is within 10 degrees and 0.3 m of the truth */
  const char* advice;    /* what would help where it is not verified: wait, turn_around, move_on, more_coverage,
                            twin or clear_view; none where nothing would */
} liloc_reply;

typedef struct liloc_stats {
  uint64_t frames;         /* processed */
  uint64_t frames_dropped; /* the queue was full */
  uint64_t frames_refused; /* unusable: wrong size, or a stamp that was not newer, far off or in another unit */
  uint64_t frames_uninformative;
  uint64_t imu_refused;
  uint64_t requests, requests_unsent, requests_unanswered;
  uint64_t replies, replies_verified, replies_refused;
  double frame_ms_median, frame_ms_p99; /* over the last 512 frames */
  uint64_t frames_skipped;              /* left out because the computer, or its share, is too small */
  uint64_t odometry_refused;
  double cpu_s;      /* CPU time of the registration so far */
  char problem[256]; /* what is wrong with the input now, for people; "": nothing was noticed */
  /* How far the device's clock runs ahead of the ceiling's, by the frames' stamps and the exchanges with the
   * server. clock_good: known well enough to be used where it matters. */
  double clock_offset_ms, clock_round_trip_ms;
  bool clock_good;
  uint64_t clock_jumps; /* a clock was set; what was learned of it is forgotten */
  double localized_s;   /* of the device's time, with a global pose; cpu_s over it is what a second costs */
} liloc_stats;

typedef struct liloc_client liloc_client;

/* For every processed frame, on the registration thread: a slow callback delays the next frame. */
typedef void (*liloc_pose_callback)(const liloc_pose_update* update, void* user);
/* For every reply, on the network thread. */
typedef void (*liloc_reply_callback)(const liloc_reply* reply, void* user);
/* For every line of the log, on any thread, which may ask any client for its stats; level is a liloc_log_level. */
typedef void (*liloc_log_callback)(int level, const char* line, void* user);

/* "0.1.0": of the library that runs, not of this header. */
const char* liloc_client_version(void);
/* Text of the last failed call of this thread, "" before the first; lives until its next failed call. */
const char* liloc_client_last_error(void);
/* "LILOC_OK" and so on; "unknown status" for what is none. */
const char* liloc_client_status_name(int status);

/* Where the log goes, of all clients of the process. NULL: nowhere, as at the start. Waits for calls of the callback
 * before, except from inside one: hold no lock that it needs. What belongs to it may be freed afterwards. */
liloc_status liloc_client_set_log(liloc_log_callback callback, void* user);

/* Pass sizeof *options, here and below. */
liloc_status liloc_client_options_init(liloc_client_options* options, size_t size);

/* Copies the options, texts included; nothing runs yet. *client is NULL after an error. */
liloc_status liloc_client_create(const liloc_client_options* options, size_t size, liloc_client** client);
/* Before start. NULL: none. `user` is handed back as it is. */
liloc_status liloc_client_on_pose(liloc_client* client, liloc_pose_callback callback, void* user);
liloc_status liloc_client_on_reply(liloc_client* client, liloc_reply_callback callback, void* user);

/* Checks the options, joins the network, starts the threads. A server that is not there is no error: the client
 * waits for it. After an error it may be tried again. */
liloc_status liloc_client_start(liloc_client* client);

/* Row-major 16-bit z-depth of the camera's size, 0 = no return; copied. A full queue drops its oldest frame. */
liloc_status liloc_client_push_depth(liloc_client* client, const uint16_t* units, int32_t width, int32_t height,
                                     int64_t stamp_ns);
/* IMU axes, three values each, finite; `specific_force_m_s2`: a device at rest reads +g upwards. */
liloc_status liloc_client_push_imu(liloc_client* client, int64_t stamp_ns, const double* angular_velocity_rad_s,
                                   const double* specific_force_m_s2);

/* `xyz`: `count` points in the sensor's frame, three floats each, copied; in place of a depth image. Of the
 * points, those within options.camera are used: give it the sensor's field of view and about as many pixels as
 * it has points there. At most 4 million. */
liloc_status liloc_client_push_points(liloc_client* client, const float* xyz, size_t count, int64_t stamp_ns);
/* With LILOC_LOCAL_EXTERNAL: where the odometry has the base, in its own frame; often, and in order. A gap over
 * a second or a discontinuity starts a new odom_segment. `covariance`: NULL, or 36 values of the pose, row-major, [rad;
 * m]; its growth bounds the motion's error; NaN or a negative variance: unknown. */
liloc_status liloc_client_push_odometry(liloc_client* client, int64_t stamp_ns, const liloc_pose* T_odom_base,
                                        const double* covariance);

/* Of the newest processed frame; also after stop. Pass sizeof *update. */
liloc_status liloc_client_newest(const liloc_client* client, liloc_pose_update* update, size_t size);
liloc_status liloc_client_stats(const liloc_client* client, liloc_stats* stats, size_t size);

/* Takes no more frames, finishes those that wait, sends what is due, writes the trace; no callback runs after
 * it. LILOC_FAILED: the trace's error, and it is stopped all the same. A second stop does nothing. There is no
 * start after it: create another client. */
liloc_status liloc_client_stop(liloc_client* client);
/* Stops where that was not done, and frees. NULL is fine. Refused (and nothing freed) inside a callback. The trace's
 * error goes to the log: call liloc_client_stop first to have it. */
liloc_status liloc_client_destroy(liloc_client* client);

#ifdef __cplusplus
}
#endif
#endif /* LILOC_CLIENT_H */
