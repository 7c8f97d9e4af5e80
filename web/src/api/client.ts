// HTTP client of /api/v1. Every failure becomes an ApiError that carries a Problem.

import { base, site } from "../core/address";
import { student as who } from "../core/prefs";
import { t } from "../core/texts";
import { askHere, isHere } from "../engine/here";
import { fileAnswer, fileUrl, needsServer } from "./files";
import type { Numbers } from "./numbers";
import { canChoosePlace, computedHere, computeHereMeanwhile } from "./place";
import type {
  AfterChange,
  Answer,
  AppliedRegrade,
  AssignedLesson,
  BothVerdicts,
  Camera,
  CheckReport,
  ClassView,
  ClassWords,
  Drag,
  Drawing,
  Filled,
  GivenPrediction,
  GivenVerdict,
  Glance,
  GradedSubmission,
  GradeTable,
  Hint,
  ImportedRobot,
  Jacobian,
  JointMultipliers,
  KeptSubmission,
  LectureState,
  Lesson,
  LessonFigures,
  LessonSummary,
  Me,
  ModesAbout,
  Motion,
  NotionGraph,
  OpenedLecture,
  PersonRecord,
  Pictures,
  PlatformList,
  Policy,
  PolicyPreview,
  PredictionCounts,
  PresenterState,
  Problem,
  QuestionAnalysis,
  Reactions,
  RegradePreview,
  RegradeProgress,
  Scene,
  SceneEntry,
  SessionScene,
  SessionState,
  Somebody,
  SubmissionState,
  SymmetricMatrix,
  TableRequest,
  Taken,
  Understood,
  WayOut,
  Welcome,
} from "./types";

const BASE = "/api/v1";
/** Seconds that a request waits for a verdict. */
const WAIT = 8;
/** Pause after which a server is asked again that is away, ms. */
const AGAIN_MS = 2000;
/** Ends what is still asked of a run when the page leaves it: its end may overtake the question. By the run's address. */
const leaving = new Map<string, AbortController>();

export class ApiError extends Error {
  constructor(readonly problem: Problem) {
    super(problem.detail ?? problem.title);
  }

  /** True when the server could not be reached at all. */
  get offline(): boolean {
    return this.problem.code === "server-unreachable";
  }

  /** True when the server, or a proxy before it, says nothing of what was asked: asked again, it may. */
  get away(): boolean {
    return this.offline || [502, 503, 504].includes(this.problem.status ?? 0);
  }

  get gone(): boolean {
    return this.problem.status === 404 || this.problem.status === 410;
  }
}

/** Any thrown value as a Problem that can be shown. */
export function problemOf(error: unknown): Problem {
  if (error instanceof ApiError) return error.problem;
  if (isProblem(error)) return error;
  const detail = error instanceof Error ? error.message : String(error);
  return {
    title: t("Something in this page failed"),
    detail,
    hint: t("Reload the page; if it happens again, report the text above."),
  };
}

function isProblem(value: unknown): value is Problem {
  return (
    typeof value === "object" &&
    value !== null &&
    !(value instanceof Error) &&
    typeof (value as Problem).title === "string"
  );
}

async function failure(response: Response): Promise<ApiError> {
  const fallback: Problem = {
    title: t("The server answered {status} {statusText}", {
      status: response.status,
      statusText: response.statusText,
    }).trim(),
    status: response.status,
    hint: t("Try again in a moment."),
  };
  const kind = response.headers.get("content-type") ?? "";
  if (!kind.includes("json")) return new ApiError(fallback);
  try {
    const body = (await response.json()) as Partial<Problem>;
    return new ApiError({ ...fallback, hint: undefined, ...body });
  } catch {
    return new ApiError(fallback);
  }
}

async function call<T>(...request: Parameters<typeof ask>): Promise<T> {
  const response = await ask(...request);
  const text = await response.text();
  return (text === "" ? undefined : JSON.parse(text)) as T;
}

async function ask(
  method: string,
  path: string,
  body?: unknown,
  signal?: AbortSignal,
  key?: string,
  more?: Record<string, string>,
): Promise<Response> {
  const below = path.startsWith(BASE) ? path.slice(BASE.length) : path;
  if (isAnsweredHere(method, below)) return hereAnswer(method, below, body);
  if (site) return method === "GET" ? fileAnswer(below).then(whole) : whole(needsServer());
  let response: Response;
  const until = signal ?? untilLeft(below);
  try {
    const headers: Record<string, string> = { accept: "application/json, application/problem+json", ...more };
    if (body !== undefined) headers["content-type"] = "application/json";
    if (key !== undefined) headers.authorization = `Bearer ${key}`;
    response = await fetch(base + (path.startsWith("/api/") ? path : BASE + path), {
      method,
      headers,
      signal: until ?? null,
      body: body === undefined ? null : typeof body === "string" ? body : JSON.stringify(body),
    });
  } catch (error) {
    if (until?.aborted) throw error;
    throw new ApiError({
      title: t("The server does not answer"),
      code: "server-unreachable",
      detail: t("The page could not reach Triad's server."),
      hint: t("Is it still running? Start it again with “triad serve”; this page then carries on by itself."),
    });
  }
  return whole(response);
}

/** Until when something asked of a run matters; none for what is asked of something else. */
function untilLeft(path: string): AbortSignal | undefined {
  const run = /^\/sessions\/[^/?]+/.exec(path)?.[0];
  if (run === undefined) return undefined;
  const left = leaving.get(run) ?? new AbortController();
  leaving.set(run, left);
  return left.signal;
}

/** The answer, unless it is a refusal. */
async function whole(response: Response): Promise<Response> {
  if (!response.ok) throw await failure(response);
  return response;
}

/** Requests that the engine in this page answers: those to its own runs, and without a server all that only compute. */
function isAnsweredHere(method: string, path: string): boolean {
  if (path === "/sessions") return method === "POST" && computedHere();
  if (path.startsWith("/sessions/")) return isHere(path);
  return site && /^\/(?:scenes|check|analyses)(?:$|\/)/.test(path) && !path.endsWith("/motion");
}

async function hereAnswer(method: string, path: string, body: unknown): Promise<Response> {
  const sent = typeof body === "string" ? (JSON.parse(body) as unknown) : body;
  const { status, text } = await askHere(method, path, sent);
  const kind = status < 400 ? "application/json" : "application/problem+json";
  return whole(new Response(text, { status, headers: { "content-type": kind } }));
}

const id = encodeURIComponent;

/** Waits for what is to be graded. Each request is answered as the verdict comes, or after some seconds with the place in the queue. */
async function graded(state: SubmissionState, waiting: (before: number) => void): Promise<GradedSubmission> {
  if (state.verdict) return state.verdict;
  if (state.state === "failed")
    throw new ApiError({
      title: t("Not graded"),
      code: "not-graded",
      detail: t("Your answers are kept, but the server could not grade them. That is its fault, not yours."),
      hint: t("No attempt is used. Tell your teacher; there is nothing to send again."),
    });
  waiting(state.before ?? 0);
  return graded(await nextState(state), waiting);
}

async function nextState(state: SubmissionState): Promise<SubmissionState> {
  try {
    return await call<SubmissionState>("GET", `/submissions/${id(state.id)}?wait=${WAIT}`);
  } catch (error) {
    // What was accepted is kept: a server that is away comes back, or another one answers.
    if (!(error instanceof ApiError && error.away)) throw error;
    await new Promise((done) => setTimeout(done, AGAIN_MS));
    return state;
  }
}

const when = (at: number | undefined): string => (at === undefined ? "" : `?at=${at}`);

/** Whose numbers: a student's name, or another seed. */
const whose = (seed?: string): string => (seed && !who.known() ? `?${new URLSearchParams({ seed })}` : "");

/** The same without what an account says by itself. */
function own<T extends object>(body: T): T {
  if (!who.known()) return body;
  const rest: T & { student?: unknown; seed?: unknown } = { ...body };
  delete rest.student;
  delete rest.seed;
  return rest;
}

/** What is handed in. */
export interface Handed {
  student?: string;
  seed?: string;
  answers: Record<string, Answer>;
}

export type SessionSource = { lesson: string; seed?: string } | { builtin: string } | { scene: unknown };

/** What a run in this page begins with: the engine knows no lessons, so that their scenes are sent along. */
async function withScene(source: SessionSource): Promise<object> {
  if (!("lesson" in source)) return source;
  const { scene } = await api.lesson(source.lesson, source.seed ?? "");
  return { lesson: source.lesson, scene };
}

export const api = {
  me: () => call<Me>("GET", "/me"),
  setUp: (body: { token: string; name: string; title?: string }) => call<Welcome>("POST", "/setup", body),
  join: (body: { code: string; name: string }) => call<Welcome>("POST", "/join", body),
  comeBack: (body: { name: string; words: string } | { link: string }) => call<Me>("POST", "/return", body),
  signOut: () => call<void>("POST", "/sign-out"),
  connectAccount: () => call<WayOut>("POST", "/me/account"),
  disconnectAccount: () => call<void>("DELETE", "/me/account"),
  class: () => call<ClassView>("GET", "/course"),
  changeClass: (change: { title?: string; join_open?: boolean; new_code?: boolean }) =>
    call<ClassView>("PUT", "/course", change),
  standings: () => call<GradeTable>("GET", "/standings"),
  standingsUrl: (format: "plain" | "canvas" | "moodle"): string => `${BASE}/standings.csv?for=${format}`,
  standingsLinesUrl: `${BASE}/standings.jsonl`,
  fillCanvas: (file: string) => call<Filled>("POST", "/standings/canvas", { file }),
  glance: () => call<Glance>("GET", "/glance"),
  platforms: () => call<PlatformList>("GET", "/lti"),
  takeRoster: () => call<Taken>("POST", "/lti/roster"),
  sendScores: () => call<PlatformList>("POST", "/lti/scores"),
  people: () => call<Somebody[]>("GET", "/people"),
  setRole: (person: string, role: string) => call<void>("PUT", `/people/${id(person)}/role`, { role }),
  erase: (person: string, body: { reason: string; answers_stay: boolean }) =>
    call<void>("POST", `/people/${id(person)}/erase`, body),
  invite: (role: string) => call<{ token: string }>("POST", "/invitations", { role }),
  newWords: (person: string) => call<{ words: string; link: string }>("POST", `/people/${id(person)}/words`),
  submissionsOf: (person: string) => call<KeptSubmission[]>("GET", `/people/${id(person)}/submissions`),
  decide: (
    person: string,
    decision: { lesson: string; question?: string; points: number | null; reason: string },
  ) => call<void>("POST", `/people/${id(person)}/decisions`, decision),
  assignments: () => call<AssignedLesson[]>("GET", "/assignments"),
  /** What a class predicted and explained in a lesson. */
  classWords: (slug: string) => call<ClassWords>("GET", `/assignments/${id(slug)}/words`),
  /** Sets a policy in the place of the version that was read; the version of the new one. */
  setPolicy: async (slug: string, policy: Policy, version: string): Promise<string> => {
    const path = `/assignments/${id(slug)}?${new URLSearchParams({ version })}`;
    const answer = await ask("PUT", path, policy);
    return (answer.headers.get("etag") ?? "").replaceAll('"', "");
  },
  releaseResults: (slug: string, released: boolean) =>
    call<void>("PUT", `/assignments/${id(slug)}/release`, { released }),
  extend: (slug: string, person: string, body: { until?: string; attempts: number; reason: string }) =>
    call<void>("PUT", `/assignments/${id(slug)}/extensions/${id(person)}`, body),
  takeBackExtension: (slug: string, person: string) =>
    call<void>("DELETE", `/assignments/${id(slug)}/extensions/${id(person)}`),
  previewPolicy: (slug: string, body: { policy?: Policy; person?: string; at?: string }) =>
    call<PolicyPreview>("POST", `/assignments/${id(slug)}/preview`, body),
  figures: (slug: string) => call<LessonFigures>("GET", `/assignments/${id(slug)}/questions`),
  figuresUrl: (slug: string, kind: "csv" | "json"): string =>
    `${BASE}/assignments/${id(slug)}/questions${kind === "csv" ? ".csv" : ""}`,
  analysis: (slug: string, question: string) =>
    call<QuestionAnalysis>("GET", `/assignments/${id(slug)}/questions/${id(question)}`),
  analysisUrl: (slug: string, question: string): string =>
    `${BASE}/assignments/${id(slug)}/questions/${id(question)}`,
  answersUrl: (slug: string, question: string): string =>
    `${BASE}/assignments/${id(slug)}/questions/${id(question)}/answers.csv`,
  regradeProgress: (slug: string) => call<RegradeProgress>("GET", `/assignments/${id(slug)}/regrades`),
  previewRegrade: (slug: string) => call<RegradePreview>("POST", `/assignments/${id(slug)}/regrades`),
  regrades: () => call<AppliedRegrade[]>("GET", "/regrades"),
  bothVerdicts: (regrade: string, submission: string) =>
    call<BothVerdicts>("GET", `/regrades/${id(regrade)}/submissions/${id(submission)}`),
  applyRegrade: (regrade: string, body: { choice: "replace" | "better"; reason: string }) =>
    call<void>("POST", `/regrades/${id(regrade)}/apply`, body),
  undoRegrade: (regrade: string) => call<void>("POST", `/regrades/${id(regrade)}/undo`),
  record: () => call<PersonRecord>("GET", "/record"),
  recordOf: (person: string) => call<PersonRecord>("GET", `/people/${id(person)}/record`),
  askAgain: (lesson: string, text: string) => call<void>("POST", "/record/requests", { lesson, text }),
  comment: (person: string, lesson: string, text: string) =>
    call<void>("POST", `/people/${id(person)}/comments`, { lesson, text }),
  fileUrl: (submission: string, question: string): string =>
    `${BASE}/submissions/${id(submission)}/files/${id(question)}`,
  verdicts: (submission: string) => call<GivenVerdict[]>("GET", `/submissions/${id(submission)}/verdicts`),

  notions: () => call<NotionGraph>("GET", "/notions"),
  lessons: (signal?: AbortSignal) => call<LessonSummary[]>("GET", "/lessons", undefined, signal),
  lesson: (slug: string, seed: string, signal?: AbortSignal) =>
    call<Lesson>("GET", `/lessons/${id(slug)}${whose(seed)}`, undefined, signal),
  predictions: (slug: string, student: string) =>
    call<GivenPrediction[]>(
      "GET",
      `/lessons/${id(slug)}/predictions${who.known() ? "" : `?${new URLSearchParams({ student })}`}`,
    ),
  /** Without a choice: skipped, and kept as that. */
  predict: (
    slug: string,
    body: { student: string; prediction: string; choice: string | null; why: string },
  ) => call<GivenPrediction>("POST", `/lessons/${id(slug)}/predictions`, own(body)),
  predictionCounts: (slug: string) =>
    call<PredictionCounts[]>("GET", `/lessons/${id(slug)}/predictions/counts`),
  hint: (slug: string, question: string, k: number, seed?: string) =>
    call<Hint>("GET", `/lessons/${id(slug)}/questions/${id(question)}/hints/${k}${whose(seed)}`),
  reading: (
    slug: string,
    question: string,
    answer: { value: NonNullable<Answer["value"]>; unit?: string },
    signal?: AbortSignal,
  ) => call<Understood>("POST", `/lessons/${id(slug)}/questions/${id(question)}/reading`, answer, signal),
  /** The table that a question asks for, of a run of one's own scene from its start: CSV. */
  askedTable: (slug: string, question: string, scene: Scene): Promise<string> =>
    ask("POST", `/lessons/${id(slug)}/questions/${id(question)}/table`, { scene }, undefined, undefined, {
      accept: "text/csv, application/problem+json",
    }).then((response) => response.text()),
  statesUrl: (slug: string, question: string, seed?: string): string =>
    site
      ? fileUrl(`/lessons/${id(slug)}/questions/${id(question)}/states`)
      : `${BASE}/lessons/${id(slug)}/questions/${id(question)}/states${whose(seed)}`,
  starterUrl: (slug: string, question: string, language: string): string =>
    site
      ? fileUrl(`/lessons/${id(slug)}/questions/${id(question)}/starters/${language}`)
      : `${BASE}/lessons/${id(slug)}/questions/${id(question)}/starters/${language}`,
  /** A request that is sent again under the same name is one submission. */
  submit: (
    slug: string,
    body: Handed,
    name: string,
    waiting: (before: number) => void,
  ): Promise<GradedSubmission> =>
    ask("POST", `/lessons/${id(slug)}/submissions`, own(body), undefined, undefined, {
      "idempotency-key": name,
    }).then(async (response) =>
      response.status === 202
        ? graded(await response.json(), waiting)
        : ((await response.json()) as GradedSubmission),
    ),
  submissions: (query: { student: string; lesson?: string; limit?: number }, signal?: AbortSignal) => {
    const search = new URLSearchParams(who.known() ? {} : { student: query.student });
    if (query.lesson) search.set("lesson", query.lesson);
    search.set("limit", String(query.limit ?? 50));
    return call<GradedSubmission[]>("GET", `/submissions?${search}`, undefined, signal);
  },

  scenes: (signal?: AbortSignal) => call<SceneEntry[]>("GET", "/scenes", undefined, signal),
  scene: (name: string, signal?: AbortSignal) => call<Scene>("GET", `/scenes/${id(name)}`, undefined, signal),
  /** The first seconds of a run, recorded: no session is needed. */
  motion: (of: "scenes" | "lessons", name: string, signal?: AbortSignal) =>
    call<Motion>("GET", `/${of}/${id(name)}/motion`, undefined, signal),
  /** All scenes and lessons at their starts. */
  pictures: (signal?: AbortSignal) => call<Pictures>("GET", "/pictures", undefined, signal),
  check: (sceneText: string, signal?: AbortSignal) => call<CheckReport>("POST", "/check", sceneText, signal),

  analyse: <T>(
    kind: "assembly" | "kinematics" | "equilibrium" | "modes",
    query: { scene: unknown; about?: ModesAbout },
  ) => call<T>("POST", `/analyses/${kind}`, query),
  /** A run from the start as a table: CSV. */
  table: (query: TableRequest): Promise<Blob> =>
    ask("POST", "/analyses/table", query, undefined, undefined, {
      accept: "text/csv, application/problem+json",
    }).then((response) => response.blob()),
  importUrdf: (urdf: string, side: unknown) =>
    call<ImportedRobot>("POST", "/import/urdf", side === undefined ? { urdf } : { urdf, with: side }),
  sceneSchema: () => call<unknown>("GET", "/schema/scene"),

  // The address of a run is that of its session, or of the lecture that follows it.
  createSession: async (source: SessionSource, change?: Numbers) => {
    const begin = (sent: object): Promise<SessionState> =>
      call<SessionState>("POST", "/sessions", change ? { ...sent, change } : sent);
    if (!computedHere()) {
      try {
        return await begin(own(source));
      } catch (error) {
        // A class may have more pages than its server has places: what it does not take is computed here.
        const full = error instanceof ApiError && error.problem.code === "too-many-sessions";
        if (!full || !canChoosePlace()) throw error;
        computeHereMeanwhile();
      }
    }
    return begin(await withScene(source));
  },
  state: (run: string) => call<SessionState>("GET", run),
  sceneOf: (run: string) => call<SessionScene>("GET", `${run}/scene`),
  jacobian: (run: string, at?: number) => call<Jacobian>("GET", `${run}/jacobian${when(at)}`),
  symmetric: (run: string, which: "augmented" | "schur", at?: number) =>
    call<SymmetricMatrix>("GET", `${run}/${which}${when(at)}`),
  multipliers: (run: string, at?: number) => call<JointMultipliers[]>("GET", `${run}/multipliers${when(at)}`),
  reactions: (run: string, query: { on: string; about: string; in: string }, at?: number) =>
    call<Reactions>(
      "GET",
      `${run}/reactions?${new URLSearchParams({ ...query, ...(at === undefined ? {} : { at: String(at) }) })}`,
    ),
  change: (run: string, numbers: Numbers, then?: AfterChange) =>
    call<SessionState>("POST", `${run}/parameters`, then ? { ...numbers, then } : numbers),
  draw: (run: string, arrows: Pick<Drawing, "on" | "about" | "drawn" | "marked"> | undefined, fit: boolean) =>
    call<SessionState>("PUT", `${run}/drawing`, arrows ? { arrows, fit } : { fit }),
  lookFrom: (run: string, from: Camera) => call<SessionState>("PUT", `${run}/camera`, { from }),
  pull: (run: string, pull: Drag) => call<SessionState>("PUT", `${run}/pull`, pull),
  release: (run: string) => call<SessionState>("DELETE", `${run}/pull`),
  step: (run: string, by: { steps: number } | { seconds: number }) =>
    call<SessionState>("POST", `${run}/step`, by),
  play: (run: string, speed: number) => call<SessionState>("POST", `${run}/play`, { speed }),
  pause: (run: string) => call<SessionState>("POST", `${run}/pause`),
  reset: (run: string) => call<SessionState>("POST", `${run}/reset`),
  /** Sent while the page goes away, so nobody waits for the answer. */
  dropSession: (run: string): void => {
    const below = run.slice(BASE.length);
    leaving.get(below)?.abort();
    leaving.delete(below);
    if (isHere(run)) void askHere("DELETE", below, undefined);
    else void fetch(base + run, { method: "DELETE", keepalive: true }).catch(() => undefined);
  },

  openLecture: (session: string, own?: { name: string; secret: string }) =>
    call<OpenedLecture>("POST", "/rooms", { session, ...own }),
  lecture: (code: string, signal?: AbortSignal) =>
    call<LectureState>("GET", `/rooms/${id(code)}`, undefined, signal),
  closeLecture: (code: string, key: string) =>
    call<void>("DELETE", `/rooms/${id(code)}`, undefined, undefined, key),
  show: (code: string, key: string, what: { session?: string; view?: unknown }) =>
    call<void>("PUT", `/rooms/${id(code)}/view`, what, undefined, key),
  presenterState: (code: string, key: string) =>
    call<PresenterState>("GET", `/rooms/${id(code)}/desk`, undefined, undefined, key),
  ask: (code: string, key: string, question: { text: string; choices: string[]; right: number | null }) =>
    call<void>("PUT", `/rooms/${id(code)}/question`, question, undefined, key),
  reveal: (code: string, key: string) =>
    call<void>("POST", `/rooms/${id(code)}/reveal`, undefined, undefined, key),
  askSecondTime: (code: string, key: string) =>
    call<void>("POST", `/rooms/${id(code)}/second-vote`, undefined, undefined, key),
  remark: (code: string, remark: { text: string; voter: string }) =>
    call<void>("POST", `/rooms/${id(code)}/remarks`, remark),
  showRemark: (code: string, key: string, number: number, shown: boolean) =>
    call<void>("PUT", `/rooms/${id(code)}/remarks/${number}`, { shown }, undefined, key),
  settleRemark: (code: string, key: string, number: number) =>
    call<void>("DELETE", `/rooms/${id(code)}/remarks/${number}`, undefined, undefined, key),
  lowerHands: (code: string, key: string) =>
    call<void>("DELETE", `/rooms/${id(code)}/hands`, undefined, undefined, key),
  withdrawQuestion: (code: string, key: string) =>
    call<void>("DELETE", `/rooms/${id(code)}/question`, undefined, undefined, key),
  answer: (code: string, vote: { question: number; voter: string; choice: number }) =>
    call<void>("POST", `/rooms/${id(code)}/answers`, vote),

  /** The address of a stream, as the browser opens it; that of a run in this page stays as it is. */
  streamUrl: (path: string): string => {
    if (isHere(path)) return path;
    const url = new URL(base + path, location.href);
    url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
    return url.href;
  },
};
