#include "tests/stream/simulated_owner.h"

#include <algorithm>
#include <ctime>

#include "base/counter_random.h"

namespace froth::test {

namespace {

// Of the processor for this thread: others on the machine do not count.
double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

uint32_t SimulatedOwner::addAsset(const LevelGraph& graph) {
  const uint32_t asset = streamer.addAsset(graph);
  if (asset == graphs_.size()) {
    graphs_.emplace_back();
    chunks_.emplace_back();
  }
  graphs_[asset] = &graph;
  chunks_[asset].assign(graph.chunkCount(), {});
  for (uint32_t i = 0; i < graph.chunkCount(); ++i) chunks_[asset][i].bytes = graph.chunk(i).bytes;
  return asset;
}

void SimulatedOwner::setBudget(uint64_t bytes) {
  if (streamer.setBudget(bytes)) budget_ = bytes;
}

void SimulatedOwner::runFrame() {
  const uint64_t heldBefore = heldBytes_;
  ++frame_;
  finishTasks();
  const auto inFlight = static_cast<uint32_t>(
      std::ranges::count_if(tasks_, [](const Task& task) { return task.reached != ChunkState::kAbsent; }));
  const double begin = threadSeconds();
  const StreamActions& actions = streamer.update(options_.readsInFlight - std::min(options_.readsInFlight, inFlight));
  updateSeconds_ = threadSeconds() - begin;
  take(actions);
  expect(heldBytes_ <= std::max(budget_, heldBefore), "holds more bytes than the budget");
  expect(streamer.statistics().usedBytes == heldBytes_, "counts other bytes than are held");
  if (options_.checksCuts) checkCuts();
}

uint32_t SimulatedOwner::settle(uint32_t mostFrames) {
  for (uint32_t frames = 0; frames < mostFrames; ++frames) {
    runFrame();
    if (streamer.isSettled()) return frames;
  }
  return mostFrames;
}

std::vector<ChunkId> SimulatedOwner::drawnChunks() const {
  std::vector<ChunkId> drawn;
  for (uint32_t asset = 0; asset < chunks_.size(); ++asset) {
    for (uint32_t i = 0; i < chunks_[asset].size(); ++i) {
      if (chunks_[asset][i].isDrawn) drawn.push_back({asset, i});
    }
  }
  return drawn;
}

void SimulatedOwner::expect(bool isTrue, const char* what, ChunkId id) {
  if (isTrue || !violation_.empty()) return;
  violation_ = "frame " + std::to_string(frame_) + ", chunk " + std::to_string(id.asset) + "." +
               std::to_string(id.chunk) + ": " + what;
}

void SimulatedOwner::finishTasks() {
  for (size_t i = 0; i < tasks_.size();) {
    if (tasks_[i].dueFrame > frame_ || finish(tasks_[i])) {
      ++i;
    } else {
      tasks_.erase(tasks_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
}

bool SimulatedOwner::finish(const Task& task) {
  Task& next = tasks_[static_cast<size_t>(&task - tasks_.data())];
  Chunk& of = chunk(task.id);
  if (task.reached == ChunkState::kAbsent) {
    of.isEvicting = of.isHeld = false;
    heldBytes_ -= of.bytes;
    streamer.completeEviction(task.id);
    return false;
  }
  // What is not broken comes at the last attempt, or the settled set would depend on chance.
  const bool fails = std::uniform_real_distribution<double>()(random_) < options_.failureShare / 4 &&
                     of.failures < ChunkStreamer::kMostRetries;
  if (fails || (of.isBroken && task.reached == ChunkState::kReady)) {
    of.isHeld = false;
    heldBytes_ -= of.bytes;
    ++of.failures;
    streamer.fail(task.id, !of.isBroken || random_() % 8 != 0);
    return false;
  }
  streamer.advance(task.id, task.reached);
  if (task.reached == ChunkState::kResident) {
    of.isResident = true;
    of.failures = 0;
    of.sinceFrame = frame_;
    return false;
  }
  next.reached = static_cast<ChunkState>(static_cast<uint8_t>(task.reached) + 1);
  next.dueFrame = frame_ + delay();
  return true;
}

void SimulatedOwner::take(const StreamActions& actions) {
  const auto note = [&](ChunkId id, uint64_t kind) {
    digest_ = mixBits(digest_ ^ (uint64_t{id.asset} << 40 | kind << 32 | id.chunk));
  };
  for (const ChunkId id : actions.shown) {
    expect(!chunk(id).isDrawn, "is shown twice", id);
    chunk(id).isDrawn = true;
    note(id, 1);
  }
  for (const ChunkId id : actions.hidden) {
    expect(chunk(id).isDrawn, "is hidden, but was not drawn", id);
    chunk(id).isDrawn = false;
    chunk(id).sinceFrame = frame_;
    note(id, 2);
  }
  for (const ChunkId id : actions.evictions) {
    Chunk& of = chunk(id);
    expect(of.isHeld && !of.isEvicting, "is evicted, but not there", id);
    expect(!of.isDrawn, "is evicted while it is drawn", id);
    expect(frame_ - of.sinceFrame >= options_.stream.keepFrames || !streamer.isPlaced(id.asset), "is evicted too soon",
           id);
    of.isResident = false;
    of.isEvicting = true;
    std::erase_if(tasks_, [&](const Task& task) { return task.id == id; });
    tasks_.push_back({id, ChunkState::kAbsent, frame_ + 1 + delay()});
    note(id, 3);
  }
  for (const ChunkId id : actions.reads) {
    Chunk& of = chunk(id);
    expect(!of.isHeld, "is read, but there already", id);
    of.isHeld = true;
    of.sinceFrame = frame_;
    heldBytes_ += of.bytes;
    tasks_.push_back({id, ChunkState::kDecoding, frame_ + 1 + delay()});
    note(id, 4);
  }
}

void SimulatedOwner::checkCuts() {
  for (uint32_t asset = 0; asset < chunks_.size(); ++asset) {
    if (streamer.hasAsset(asset)) checkCut(asset);
  }
}

// The definition of docs/STREAMING.md, on the chunks that the owner was told to draw.
void SimulatedOwner::checkCut(uint32_t asset) {
  const LevelGraph& graph = *graphs_[asset];
  const GroupSet& refined = streamer.refined(asset);
  for (const uint32_t group : refined.members()) {
    for (const uint32_t coarser : graph.coarserThan(group)) {
      expect(refined.contains(coarser), "a group is refined below one that is not", {asset, group});
    }
  }
  for (uint32_t i = 0; i < graph.chunkCount(); ++i) {
    const Chunk& of = chunks_[asset][i];
    const bool isInCut = streamer.isShown(asset) && isDrawnIn(refined, graph.chunk(i));
    expect(of.isDrawn == isInCut, "is drawn where the cut does not, or the reverse: a hole or an overlap", {asset, i});
    expect(!of.isDrawn || (of.isResident && !of.isEvicting), "is drawn, but not resident", {asset, i});
  }
}

}  // namespace froth::test
