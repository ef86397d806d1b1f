#!/usr/bin/env python3
"""Checks that each header whose functions have bodies in a .cpp of its name has its tests in tests/NAME_test.cpp.

check_tests.py [ROOT]   exit 0: all have; 1: a line for each that has none, or whose entry in COVERED is stale
Headers of data alone, of templates and of inline functions may have a test, and need none. What another test covers
better than one of its own stands in COVERED, with the reason.
"""
import pathlib
import sys

PARTS = ("common", "server", "client")
# Header: (the test that covers it, why it has none of its own).
COVERED = {
    "client/api/c_api_handle.hpp": ("client/include/tests/c_api_test.cpp",
        "seen through the C API alone"),
    "client/api/c_api_structs.hpp": ("client/api/tests/c_api_fields_test.cpp",
        "field by field, for all structs of the C API"),
    "client/api/public_types.hpp": ("client/api/tests/client_test.cpp",
        "what the client hands out and takes"),
    "client/app/given_options.hpp": ("client/app/tests/options_test.cpp",
        "the command line and its files together"),
    "client/app/sensor_feed.hpp": ("client/app/tests/daemon_test.cpp",
        "topics in, frames into a client"),
    "client/python/arrays.hpp": ("client/python/tests/consumer_test.py",
        "seen from Python alone"),
    "client/python/python_client.hpp": ("client/python/tests/consumer_test.py",
        "seen from Python alone"),
    "common/credentials/pem.hpp": ("common/credentials/tests/credentials_test.cpp",
        "files that hold certificates and keys"),
    "common/protocol/spot.hpp": ("common/wire/spots/tests/convert_spot_test.cpp",
        "values, checked where they come off the wire"),
    "common/recording/bags/bag.hpp": ("common/recording/bags/tests/bags_test.cpp",
        "whole bags, as ROS writes them"),
    "common/recording/bags/chunk.hpp": ("common/recording/bags/tests/bags_test.cpp",
        "whole bags, as ROS writes them"),
    "common/recording/bags/convert.hpp": ("common/recording/bags/tests/bags_test.cpp",
        "whole bags, as ROS writes them"),
    "common/recording/bags/describe.hpp": ("common/recording/bags/tests/bags_test.cpp",
        "whole bags, as ROS writes them"),
    "common/recording/bags/frames.hpp": ("common/recording/bags/tests/bags_test.cpp",
        "whole bags, as ROS writes them"),
    "common/recording/bags/ros_messages.hpp": ("common/recording/bags/tests/hostile_bag_test.cpp",
        "damaged messages in bags"),
    "common/recording/bags/survey.hpp": ("common/recording/bags/tests/bags_test.cpp",
        "whole bags, as ROS writes them"),
    "common/testing/box_room.hpp": ("common/registration/spot/tests/align_test.cpp",
        "a world for tests; laws fail where it errs"),
    "common/testing/program.hpp": ("server/app/tests/program_test.cpp",
        "runs the programs of the tests"),
    "common/wire/dds/security.hpp": ("common/wire/tests/security_test.cpp",
        "a site of processes, attacked"),
    "server/answers/compression.hpp": ("server/answers/tests/answer_file_test.cpp",
        "whole answer files, damaged ones among them"),
    "server/answers/room_tables.hpp": ("server/answers/tests/answer_file_test.cpp",
        "the tables of an answer file"),
    "server/localization/device_session.hpp": ("server/localization/tests/localizer_test.cpp",
        "a localizer is its sessions"),
    "server/localization/spot_solver.hpp": ("server/localization/tests/bad_input_test.cpp",
        "and localizer_test.cpp, by what it answers"),
    "server/plan/evaluation.hpp": ("server/plan/tests/placement_test.cpp",
        "what placed LiDARs are worth"),
    "server/plan/study.hpp": ("server/plan/tests/placement_test.cpp",
        "on placed LiDARs"),
    "server/tools/plan/dxf_groups.hpp": ("server/tools/plan/tests/dxf_file_test.cpp",
        "whole files, damaged ones among them"),
    "server/tools/plan/plan_command.hpp": ("proto-tests/toolbox/tests/plan_test.cpp",
        "by the program that has it"),
    "server/tools/plan/plan_drawing.hpp": ("proto-tests/toolbox/tests/plan_test.cpp",
        "the pictures that the command writes"),
    "server/tools/plan/plan_input.hpp": ("proto-tests/toolbox/tests/plan_test.cpp",
        "what the command refuses"),
    "server/tools/plan/plan_report.hpp": ("proto-tests/toolbox/tests/plan_test.cpp",
        "what the command prints and writes"),
    "server/tools/recorder.hpp": ("proto-tests/toolbox/tests/record_test.cpp",
        "a program that records live topics"),
    "server/view/assets.hpp": ("server/view/tests/page_server_test.cpp",
        "as the page serves them"),
    "server/view/audience.hpp": ("server/view/tests/page_server_test.cpp",
        "who looks on, over real sockets"),
    "server/view/connection.hpp": ("server/view/tests/page_server_test.cpp",
        "over real sockets"),
    "server/view/viewer.hpp": ("server/view/tests/page_server_test.cpp",
        "over real sockets"),
    "server/web/facts.hpp": ("server/web/tests/metrics_test.cpp",
        "what the metrics say"),
}


def headers(root):
    """Of the rooms, those with a .cpp beside them; root-relative."""
    found = [path.relative_to(root) for part in PARTS for path in (root / part).rglob("*.hpp")]
    return sorted(path for path in found if "tests" not in path.parts and (root / path).with_suffix(".cpp").exists())


def test_of(header):
    return header.parent / "tests" / f"{header.stem}_test.cpp"


def check(root, covered):
    """The problems, and how many headers were looked at."""
    problems, all_headers = [], headers(root)
    for header in all_headers:
        own = test_of(header)
        entry = covered.get(str(header))
        if (root / own).exists():
            if entry:
                problems.append(f"{header}: has {own} by now: take it out of COVERED in check_tests.py")
        elif entry is None:
            problems.append(f"{header}: has no {own}: write it, or name in COVERED of check_tests.py what covers it")
        elif not (root / entry[0]).exists():
            problems.append(f"{header}: COVERED in check_tests.py names {entry[0]}, which is not there")
    known = {str(header) for header in all_headers}
    problems += [f"{name}: is no header with a .cpp any more: take it out of COVERED in check_tests.py"
                 for name in sorted(covered) if name not in known]
    return problems, len(all_headers)


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    problems, count = check(root, COVERED)
    if count == 0:
        print(f"check_tests: no header found below {root}: is it the project's root?", file=sys.stderr)
        return 1
    print("\n".join(problems) if problems else f"{count} headers have their tests, {len(COVERED)} of them elsewhere")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
