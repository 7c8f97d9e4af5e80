// Keeps this site in the browser, so that it works without a network once it was opened. Written by `triad export site`.
const KEPT = `triad-${"VERSION"}`;
const FILES = ["FILES"];

/** The page is one file, whatever is asked of it. */
const named = (url) => {
  const path = new URL(url).href.split(/[?#]/)[0];
  return path === registration.scope ? `${path}index.html` : path;
};

addEventListener("install", (event) => {
  const fetched = caches.open(KEPT).then((kept) => kept.addAll(FILES.map((file) => registration.scope + file)));
  event.waitUntil(fetched.then(() => skipWaiting()));
});

addEventListener("activate", (event) => {
  const old = caches.keys().then((names) => names.filter((name) => name.startsWith("triad-") && name !== KEPT));
  event.waitUntil(old.then((names) => Promise.all(names.map((name) => caches.delete(name)))).then(() => clients.claim()));
});

addEventListener("fetch", (event) => {
  if (event.request.method !== "GET" || !event.request.url.startsWith(registration.scope)) return;
  const found = caches.open(KEPT).then((kept) => kept.match(named(event.request.url)));
  event.respondWith(found.then((answer) => answer ?? fetch(event.request)));
});
