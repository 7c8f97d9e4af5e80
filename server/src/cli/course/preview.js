// Shows what the check says of the lesson, and loads the page again when a file was saved.
(() => {
  let version = null;
  const box = document.createElement("aside");
  box.setAttribute("role", "status");
  box.setAttribute("aria-label", "Preview");
  box.style.cssText = "position:fixed;inset:auto 1rem 1rem auto;z-index:99;max-width:36rem;max-height:45vh;overflow:auto;padding:.6rem .9rem;border-radius:.5rem;background:#5c1a00;color:#fff;font:14px/1.45 ui-monospace,monospace;white-space:pre-wrap";
  const look = async () => {
    try {
      const state = await (await fetch("/preview/state", { cache: "no-store" })).json();
      if (version !== null && state.version !== version) {
        location.reload();
        return;
      }
      version = state.version;
      box.hidden = state.faults.length === 0;
      const text = `${state.faults.length} fault${state.faults.length === 1 ? "" : "s"}\n${state.faults.map((fault) => fault.what).join("\n")}`;
      if (box.textContent !== text) box.textContent = text;
      if (!box.isConnected) document.body.append(box);
    } catch {
      // The preview was stopped; the page stays as it is.
    }
    setTimeout(look, 700);
  };
  void look();
})();
