import { loadMe } from "./api/identity";
import { fileOf, pathOf, site } from "./core/address";
import { setText } from "./core/dom";
import { loadMaths } from "./core/maths";
import { startRouter } from "./core/router";
import { loadLanguage, t } from "./core/texts";
import { applyTheme } from "./core/theme";
import { homePage } from "./pages/home";
import { lessonPage } from "./pages/lesson";
import { notFoundPage } from "./pages/not-found";
import { restoreDividers } from "./ui/divider";
import { header } from "./ui/shell";

applyTheme();
restoreDividers();
const speaks = loadLanguage();
// A lesson will need KaTeX: it is fetched beside the lesson's text, not after it.
if (pathOf(location).startsWith("/lessons/")) void loadMaths();
// A site of files keeps itself, and works without a network once it was opened.
if (site && "serviceWorker" in navigator) void navigator.serviceWorker.register(fileOf("keep.js"));

const head = document.getElementById("header");
const main = document.getElementById("main");
if (head && main) {
  // In a frame of another site nobody is signed in, and there is nowhere to go.
  // The window that a lecture hall sees has no use for a menu either.
  if (/^\/(?:embed\/|room\/[^/]+\/screen)/.test(pathOf(location))) void speaks.finally(() => routes(main));
  else void Promise.allSettled([speaks, loadMe()]).then(() => start(head, main));
}

function start(head: HTMLElement, main: HTMLElement): void {
  const skip = document.querySelector(".skip");
  if (skip) setText(skip, t("Skip to the content"));
  header(head);
  routes(main);
}

function routes(main: HTMLElement): void {
  startRouter(
    main,
    [
      { pattern: /^\/$/, open: homePage },
      { pattern: /^\/lessons\/([^/]+)$/, open: lessonPage },
      {
        pattern: /^\/lessons\/([^/]+)\/scene$/,
        open: lazily(t("Scene"), () => import("./pages/scene").then((page) => page.lessonScenePage)),
      },
      {
        pattern: /^\/room$/,
        open: lazily(t("Join a lecture"), () => import("./pages/lecture").then((page) => page.joinPage)),
      },
      {
        pattern: /^\/room\/([^/]+)$/,
        open: lazily(t("Lecture"), () => import("./pages/lecture").then((page) => page.lecturePage)),
      },
      {
        pattern: /^\/room\/([^/]+)\/screen$/,
        open: lazily(t("Lecture"), () => import("./pages/screen").then((page) => page.screenPage)),
      },
      {
        pattern: /^\/(join|setup|return)$/,
        open: lazily(t("Your class"), () => import("./class/join").then((page) => page.joinClassPage)),
      },
      {
        pattern: /^\/class$/,
        open: lazily(t("Class"), () => import("./class/overview").then((page) => page.classPage)),
      },
      {
        pattern: /^\/class\/now$/,
        open: lazily(t("At a glance"), () => import("./class/glance").then((page) => page.glancePage)),
      },
      {
        pattern: /^\/class\/people$/,
        open: lazily(t("People"), () => import("./class/people").then((page) => page.peoplePage)),
      },
      {
        pattern: /^\/class\/lessons\/([^/]+)$/,
        open: lazily(t("Lesson of the class"), () =>
          import("./class/assignment").then((page) => page.assignmentPage),
        ),
      },
      {
        pattern: /^\/class\/lessons\/([^/]+)\/questions\/([^/]+)$/,
        open: lazily(t("Question of the class"), () =>
          import("./class/question").then((page) => page.questionPage),
        ),
      },
      {
        pattern: /^\/record$/,
        open: lazily(t("Your work"), () => import("./class/record").then((page) => page.recordPage)),
      },
      {
        pattern: /^\/class\/([^/]+)$/,
        open: lazily(t("Student"), () => import("./class/student").then((page) => page.studentPage)),
      },
      {
        pattern: /^\/course$/,
        open: lazily(t("The course"), () => import("./pages/course").then((page) => page.coursePage)),
      },
      {
        pattern: /^\/scenes$/,
        open: lazily(t("Scenes"), () => import("./pages/scenes").then((page) => page.scenesPage)),
      },
      {
        pattern: /^\/scenes\/([^/]+)$/,
        open: lazily(t("Scene"), () => import("./pages/scene").then((page) => page.scenePage)),
      },
      {
        pattern: /^\/embed\/(lessons|scenes)\/([^/]+)$/,
        open: lazily(t("Mechanism"), () => import("./pages/embed").then((page) => page.embedPage)),
      },
    ],
    notFoundPage,
  );
}

type Open = Parameters<typeof startRouter>[2];

/** A page whose code is fetched when it is first visited. */
function lazily(title: string, load: () => Promise<Open>): Open {
  return (outlet, params) => {
    let left = false;
    let dispose: (() => void) | undefined;
    void load().then((open) => {
      if (!left) dispose = open(outlet, params).dispose;
    });
    return {
      title,
      dispose: () => {
        left = true;
        dispose?.();
      },
    };
  };
}
