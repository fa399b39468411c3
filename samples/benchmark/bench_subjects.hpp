#pragma once

#include "benchmark/bench.hpp"
#include "session/run.hpp"

#include <memory>

/// Benchmark subjects: the parts of the engine that are measured.
namespace catoptric::benchmark {

using namespace session;

/// Returns "session/SCENE": makes a session, which lays out and uploads the scene, and renders no
/// frame. The engine must outlive the subject.
Subject make_session_subject(Engine& engine, const scene::Scene& scene);
/// Returns "hierarchy/SCENE": builds the BVH over all triangles of the scene at rest. Counter:
/// "triangles".
Subject make_bvh_subject(const scene::Scene& scene);
/// Returns "frame/SCENE/WxH/TECHNIQUE": renders a frame of the request's one technique, from its
/// description until the device is done. Counters: "gpu_ms", "record_ms" and, for a tracer, "rays".
/// Subject::caller is "host/SCENE/WxH/TECHNIQUE": the calling thread's work for the frame
/// (update, compile, record, submit). `session`: shows the request's scene. `iterations`: number of
/// frames measured in all.
Subject make_frame_subject(std::shared_ptr<Session> session, Request request, int iterations);

} // namespace catoptric::benchmark
