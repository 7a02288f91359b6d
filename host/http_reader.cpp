#include "host/http_reader.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <curl/curl.h>

namespace froth {
namespace {

using Clock = std::chrono::steady_clock;

constexpr long kMostConnections = 6;  // as browsers open to a host; further ranges wait
constexpr std::array kRetryAfter{std::chrono::milliseconds(100), std::chrono::milliseconds(400)};
constexpr std::chrono::milliseconds kLongestWait(1000);  // curl_multi_wakeup ends a wait
constexpr uint64_t kHeadBytes = 1 << 16;                 // what Froth asks for first (froth_reader.h)

struct Transfer {
  uint64_t request = 0, offset = 0, size = 0;  // [bytes] size: what `destination` holds
  char* destination = nullptr;
  uint64_t received = 0;  // [bytes]
  double stallSeconds = 0;
  uint64_t receivedAtStep = 0;
  Clock::time_point stepAt{};  // when bytes came last; zero: libcurl has not begun
  CURL* easy = nullptr;        // null: it waits for its next attempt
  size_t attempt = 0;
  Clock::time_point due{};
  std::array<char, CURL_ERROR_SIZE> errorText{};
};

struct Fault {
  std::string text;
  bool mayPass = false;
};

long responseCode(CURL* easy) {
  long code = 0;
  curl_easy_getinfo(easy, CURLINFO_RESPONSE_CODE, &code);
  return code;
}

// Takes bytes of a partial answer alone: of any other a server might send the whole file.
size_t takeBytes(char* bytes, size_t, size_t count, void* user) {
  Transfer& transfer = *static_cast<Transfer*>(user);
  if (responseCode(transfer.easy) != 206 || count > transfer.size - transfer.received) return 0;
  std::memcpy(transfer.destination + transfer.received, bytes, count);
  transfer.received += count;
  return count;
}

// libcurl calls it once a second at least. Not 0: it ends the transfer. (CURLOPT_LOW_SPEED_TIME takes the mean of some
// seconds, in which a transfer that stalls still seems to move.)
int endIfStalled(void* user, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  Transfer& transfer = *static_cast<Transfer*>(user);
  const Clock::time_point now = Clock::now();
  if (transfer.stepAt == Clock::time_point() || transfer.received != transfer.receivedAtStep) {
    transfer.stepAt = now;
    transfer.receivedAtStep = transfer.received;
  }
  return now - transfer.stepAt > std::chrono::duration<double>(transfer.stallSeconds) ? 1 : 0;
}

// False: host memory is exhausted.
bool prepare(Transfer& transfer, const std::string& url, const HttpOptions& options) {
  transfer.received = transfer.receivedAtStep = 0;
  transfer.stepAt = {};
  transfer.stallSeconds = options.stallSeconds;
  transfer.errorText[0] = 0;
  transfer.easy = curl_easy_init();
  if (!transfer.easy) return false;
  CURL* const easy = transfer.easy;
  const std::string range = std::to_string(transfer.offset) + "-" + std::to_string(transfer.offset + transfer.size - 1);
  curl_easy_setopt(easy, CURLOPT_URL, url.c_str());
  curl_easy_setopt(easy, CURLOPT_RANGE, range.c_str());
  curl_easy_setopt(easy, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(easy, CURLOPT_FOLLOWLOCATION, 1L);
  curl_easy_setopt(easy, CURLOPT_FAILONERROR, 1L);
  curl_easy_setopt(easy, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(easy, CURLOPT_CONNECTTIMEOUT_MS, static_cast<long>(options.connectSeconds * 1000));
  curl_easy_setopt(easy, CURLOPT_NOPROGRESS, 0L);
  curl_easy_setopt(easy, CURLOPT_XFERINFODATA, &transfer);
  curl_easy_setopt(easy, CURLOPT_XFERINFOFUNCTION, endIfStalled);
  curl_easy_setopt(easy, CURLOPT_ERRORBUFFER, transfer.errorText.data());
  curl_easy_setopt(easy, CURLOPT_PRIVATE, &transfer);
  curl_easy_setopt(easy, CURLOPT_WRITEDATA, &transfer);
  curl_easy_setopt(easy, CURLOPT_WRITEFUNCTION, takeBytes);
  return true;
}

// [bytes] of the whole file, by the answer's Content-Range; 0: it tells none, or of another place in the file.
uint64_t sizeToldBy(const Transfer& transfer) {
  curl_header* header = nullptr;
  if (curl_easy_header(transfer.easy, "Content-Range", 0, CURLH_HEADER, -1, &header) != CURLHE_OK) return 0;
  uint64_t first = 0, last = 0, size = 0;
  const int fields = std::sscanf(header->value, "bytes %" SCNu64 "-%" SCNu64 "/%" SCNu64, &first, &last, &size);
  return fields == 3 && first == transfer.offset ? size : 0;
}

// What is wrong with a transfer that has ended. fileSize 0: not known yet.
std::optional<Fault> judge(const Transfer& transfer, CURLcode result, uint64_t fileSize) {
  const long code = responseCode(transfer.easy);
  if (code >= 400) return Fault{"HTTP status " + std::to_string(code), code == 408 || code == 429 || code >= 500};
  if (code == 200) {
    return Fault{"the server ignores the range and sends the whole file; serve it where ranges are served"};
  }
  if (result == CURLE_ABORTED_BY_CALLBACK) {
    return Fault{"no byte came for " + std::to_string(transfer.stallSeconds) + " s", true};
  }
  if (result != CURLE_OK) {
    const char* const text = transfer.errorText[0] ? transfer.errorText.data() : curl_easy_strerror(result);
    return Fault{text, result != CURLE_WRITE_ERROR && result != CURLE_UNSUPPORTED_PROTOCOL};
  }
  const uint64_t told = sizeToldBy(transfer);
  if (code != 206 || told == 0) return Fault{"HTTP status " + std::to_string(code) + " without the range asked for"};
  if (fileSize == 0) return std::nullopt;
  if (told != fileSize) {
    return Fault{"the file has " + std::to_string(told) + " bytes now, where it had " + std::to_string(fileSize)};
  }
  if (transfer.received != transfer.size) return Fault{"the answer is too short", true};
  return std::nullopt;
}

void release(Transfer& transfer) {
  curl_easy_cleanup(transfer.easy);
  transfer.easy = nullptr;
}

}  // namespace

struct HttpReader::State {
  ~State() { curl_multi_cleanup(multi); }

  Status readHead();
  CURLcode performAlone(CURL* easy);
  void serve();
  void begin(Transfer& transfer);
  void beginDue();
  void collect();
  void end(uint64_t request, FrothResult result);
  int waitMilliseconds() const;
  bool answersFromHead(uint64_t request, uint64_t offset, uint64_t bytes, void* destination) const;
  void tellFault(const Transfer& transfer, const std::string& text);

  std::string url;
  HttpOptions options;
  FrothContext* context = nullptr;
  uint64_t size = 0;       // [bytes] of the file
  std::vector<char> head;  // its first bytes
  CURLM* multi = nullptr;
  std::map<uint64_t, Transfer> transfers;  // by request; of the thread alone
  std::atomic<uint64_t> retries{0};

  std::mutex mutex;  // guards what follows
  std::vector<Transfer> asked;
  std::vector<uint64_t> cancelled;
  bool isEnding = false;
  std::string fault;

  std::thread thread;
};

// Its connection stays open for the ranges to come.
CURLcode HttpReader::State::performAlone(CURL* easy) {
  curl_multi_add_handle(multi, easy);
  int running = 0, left = 0;
  const CURLMsg* message = nullptr;
  while (!message && curl_multi_perform(multi, &running) == CURLM_OK) {
    message = curl_multi_info_read(multi, &left);
    if (!message) curl_multi_poll(multi, nullptr, 0, static_cast<int>(kLongestWait.count()), nullptr);
  }
  const CURLcode result = message ? message->data.result : CURLE_OUT_OF_MEMORY;
  curl_multi_remove_handle(multi, easy);
  return result;
}

Status HttpReader::State::readHead() {
  head.resize(kHeadBytes);
  Transfer transfer;
  transfer.size = head.size();
  transfer.destination = head.data();
  for (;; ++transfer.attempt) {
    if (!prepare(transfer, url, options)) return makeError(ErrorKind::kMemory, "host memory is exhausted");
    const CURLcode result = performAlone(transfer.easy);
    const std::optional<Fault> found = judge(transfer, result, 0);
    if (!found) size = sizeToldBy(transfer);
    release(transfer);
    if (!found) break;
    if (!found->mayPass || transfer.attempt == kRetryAfter.size()) {
      return makeError(ErrorKind::kBadInput, "%s: cannot be read: %s", url.c_str(), found->text.c_str());
    }
    ++retries;
    std::this_thread::sleep_for(kRetryAfter[transfer.attempt]);
  }
  head.resize(transfer.received);
  return {};
}

bool HttpReader::State::answersFromHead(uint64_t request, uint64_t offset, uint64_t bytes, void* destination) const {
  if (offset + bytes > head.size()) return false;
  std::memcpy(destination, head.data() + offset, bytes);
  frothCompleteRead(context, request, FROTH_OK);
  return true;
}

void HttpReader::State::begin(Transfer& transfer) {
  if (!prepare(transfer, url, options)) return end(transfer.request, FROTH_ERROR_MEMORY);
  curl_multi_add_handle(multi, transfer.easy);
}

void HttpReader::State::beginDue() {
  const Clock::time_point now = Clock::now();
  for (auto next = transfers.begin(); next != transfers.end();) {
    Transfer& transfer = next++->second;  // before it may be gone
    if (!transfer.easy && transfer.due <= now) begin(transfer);
  }
}

void HttpReader::State::tellFault(const Transfer& transfer, const std::string& text) {
  const std::lock_guard lock(mutex);
  fault =
      url + ": " + std::to_string(transfer.size) + " bytes at byte " + std::to_string(transfer.offset) + ": " + text;
}

void HttpReader::State::end(uint64_t request, FrothResult result) {
  const auto found = transfers.find(request);
  if (found == transfers.end()) return;  // it was answered before it was cancelled
  if (found->second.easy) {
    curl_multi_remove_handle(multi, found->second.easy);
    release(found->second);
  }
  transfers.erase(found);
  frothCompleteRead(context, request, result);
}

void HttpReader::State::collect() {
  int left = 0;
  while (const CURLMsg* message = curl_multi_info_read(multi, &left)) {
    if (message->msg != CURLMSG_DONE) continue;
    const CURLcode result = message->data.result;
    Transfer* transfer = nullptr;
    curl_easy_getinfo(message->easy_handle, CURLINFO_PRIVATE, &transfer);
    const std::optional<Fault> found = judge(*transfer, result, size);
    if (!found) {
      end(transfer->request, FROTH_OK);
    } else if (found->mayPass && transfer->attempt < kRetryAfter.size()) {
      ++retries;
      curl_multi_remove_handle(multi, transfer->easy);
      release(*transfer);
      transfer->due = Clock::now() + kRetryAfter[transfer->attempt++];
    } else {
      tellFault(*transfer, found->text);
      end(transfer->request, FROTH_ERROR_FILE);
    }
  }
}

int HttpReader::State::waitMilliseconds() const {
  std::chrono::milliseconds wait = kLongestWait;
  for (const auto& [request, transfer] : transfers) {
    if (transfer.easy) continue;
    wait = std::min(wait, std::chrono::ceil<std::chrono::milliseconds>(transfer.due - Clock::now()));
  }
  return static_cast<int>(std::max<int64_t>(wait.count(), 0));
}

void HttpReader::State::serve() {
  for (;;) {
    std::vector<Transfer> newOnes;
    std::vector<uint64_t> unwanted;
    {
      const std::lock_guard lock(mutex);
      if (isEnding) break;
      newOnes.swap(asked);
      unwanted.swap(cancelled);
    }
    for (const Transfer& transfer : newOnes) transfers.emplace(transfer.request, transfer);
    for (const uint64_t request : unwanted) end(request, FROTH_ERROR_STATE);
    beginDue();
    int running = 0;
    curl_multi_perform(multi, &running);
    collect();
    curl_multi_poll(multi, nullptr, 0, waitMilliseconds(), nullptr);
  }
  for (const Transfer& transfer : asked) transfers.emplace(transfer.request, transfer);  // nobody asks any more
  while (!transfers.empty()) end(transfers.begin()->first, FROTH_ERROR_STATE);
}

Result<std::unique_ptr<HttpReader>> HttpReader::open(const std::string& url, FrothContext* context,
                                                     const HttpOptions& options) {
  static const CURLcode isReady = curl_global_init(CURL_GLOBAL_DEFAULT);
  if (isReady != CURLE_OK) return makeError(ErrorKind::kUnsupported, "libcurl: %s", curl_easy_strerror(isReady));
  auto state = std::make_unique<State>();
  state->url = url;
  state->options = options;
  state->context = context;
  state->multi = curl_multi_init();
  if (!state->multi) return makeError(ErrorKind::kMemory, "host memory is exhausted");
  curl_multi_setopt(state->multi, CURLMOPT_MAX_HOST_CONNECTIONS, kMostConnections);
  if (Status read = state->readHead(); !read) return read.error();
  state->thread = std::thread(&State::serve, state.get());
  return std::unique_ptr<HttpReader>(new HttpReader(std::move(state)));
}

HttpReader::HttpReader(std::unique_ptr<State> state) : state_(std::move(state)) {}

HttpReader::~HttpReader() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->isEnding = true;
  }
  curl_multi_wakeup(state_->multi);
  state_->thread.join();
}

FrothReader HttpReader::reader() {
  FrothReader reader{};
  reader.structSize = sizeof(reader);
  reader.user = state_.get();
  reader.name = state_->url.c_str();
  reader.size = state_->size;
  reader.read = [](void* user, uint64_t request, uint64_t offset, uint64_t size, void* destination) {
    State& state = *static_cast<State*>(user);
    if (state.answersFromHead(request, offset, size, destination)) return;
    Transfer transfer;
    transfer.request = request;
    transfer.offset = offset;
    transfer.size = size;
    transfer.destination = static_cast<char*>(destination);
    {
      const std::lock_guard lock(state.mutex);
      state.asked.push_back(transfer);
    }
    curl_multi_wakeup(state.multi);
  };
  reader.cancel = [](void* user, uint64_t request) {
    State& state = *static_cast<State*>(user);
    {
      const std::lock_guard lock(state.mutex);
      state.cancelled.push_back(request);
    }
    curl_multi_wakeup(state.multi);
  };
  return reader;
}

std::string HttpReader::lastFault() const {
  const std::lock_guard lock(state_->mutex);
  return state_->fault;
}

uint64_t HttpReader::retries() const { return state_->retries; }

}  // namespace froth
