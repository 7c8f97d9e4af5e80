// What the server says of runs and analyses, in German; see `told.ts`.

export const toldOfRuns: Record<string, string> = {
  // Why a run cannot begin or go on.
  'the mechanism cannot be assembled near its start: joint "{joint}" stays open by {violation} of the mechanism\'s size (moved by {moved} m)':
    "der Mechanismus lässt sich nahe seinem Anfang nicht schließen: Gelenk „{joint}“ bleibt um {violation} der Größe des Mechanismus offen (verschoben um {moved} m)",
  'the mechanism cannot be assembled near its start: joint "{joint}" stays open by {violation} of the mechanism\'s size, and with it {with} (moved by {moved} m)':
    "der Mechanismus lässt sich nahe seinem Anfang nicht schließen: Gelenk „{joint}“ bleibt um {violation} der Größe des Mechanismus offen und mit ihm {with} (verschoben um {moved} m)",
  'joint "{joint}" is open at the start, and closing all joints would move bodies by {moved} m, more than the {limit} m that count as a correction':
    "Gelenk „{joint}“ ist am Anfang offen, und alle Gelenke zu schließen würde Körper um {moved} m verschieben, mehr als die {limit} m, die als Korrektur gelten",
  'the mechanism cannot be assembled near its start: driver "{driver}" stays open by {violation} of the mechanism\'s size (moved by {moved} m)':
    "der Mechanismus lässt sich nahe seinem Anfang nicht schließen: Antrieb „{driver}“ bleibt um {violation} der Größe des Mechanismus offen (verschoben um {moved} m)",
  'the mechanism cannot be assembled near its start: driver "{driver}" stays open by {violation} of the mechanism\'s size, and with it {with} (moved by {moved} m)':
    "der Mechanismus lässt sich nahe seinem Anfang nicht schließen: Antrieb „{driver}“ bleibt um {violation} der Größe des Mechanismus offen und mit ihm {with} (verschoben um {moved} m)",
  'driver "{driver}" is open at the start, and closing all joints would move bodies by {moved} m, more than the {limit} m that count as a correction':
    "Antrieb „{driver}“ ist am Anfang offen, und alle Gelenke zu schließen würde Körper um {moved} m verschieben, mehr als die {limit} m, die als Korrektur gelten",
  'driver "{driver}" asks for a motion that the joints do not allow at t = {time} s: no velocities satisfy it; the nearest miss it by {missed}/s':
    "Antrieb „{driver}“ verlangt eine Bewegung, die die Gelenke bei t = {time} s nicht erlauben: Keine Geschwindigkeiten erfüllen sie; die nächsten verfehlen sie um {missed}/s",
  'driver "{driver}" asks for a motion that the joints do not allow at t = {time} s: no velocities satisfy it together with {with}; the nearest miss it by {missed}/s':
    "Antrieb „{driver}“ verlangt eine Bewegung, die die Gelenke bei t = {time} s nicht erlauben: Keine Geschwindigkeiten erfüllen sie zusammen mit {with}; die nächsten verfehlen sie um {missed}/s",
  'the masses are too different: between {light_mass} kg of "{light}" and {heavy_mass} kg of "{heavy}" rounding cannot tell whether joint "{joint}" holds':
    "die Massen sind zu verschieden: Zwischen {light_mass} kg von „{light}“ und {heavy_mass} kg von „{heavy}“ kann die Rundung nicht sagen, ob Gelenk „{joint}“ hält",
  'the run stops at t = {time} s: joint "{joint}" is open by {violation} of the mechanism\'s size':
    "der Lauf endet bei t = {time} s: Gelenk „{joint}“ ist um {violation} der Größe des Mechanismus offen",
  'the run stops at t = {time} s: joint "{joint}" is open by {violation} of the mechanism\'s size, and with it {with}':
    "der Lauf endet bei t = {time} s: Gelenk „{joint}“ ist um {violation} der Größe des Mechanismus offen und mit ihm {with}",
  'driver "{driver}" prescribes the cosine of an angle, which at t = {time} s is {angle} rad: it cannot reach 0 or pi, where the cosine does not change with the angle, and holds nothing':
    "Antrieb „{driver}“ schreibt den Kosinus eines Winkels vor, der bei t = {time} s {angle} rad ist: Er kann 0 und pi nicht erreichen, wo der Kosinus sich mit dem Winkel nicht ändert und nichts hält",
  'nothing determines how fast body "{body}" turns: at t = {time} s {moment} N m turn it about ({x}, {y}, {z}), about which it has no inertia, or next to none, and nothing holds it there':
    "nichts bestimmt, wie schnell Körper „{body}“ sich dreht: Bei t = {time} s drehen ihn {moment} N m um ({x}, {y}, {z}), worum er keine oder fast keine Trägheit hat und nichts ihn hält",
  "the state at t = {time} s is not finite": "der Zustand bei t = {time} s ist nicht endlich",
  "the integration stops at t = {time} s: no step above {step} s meets the tolerance":
    "die Integration endet bei t = {time} s: Kein Schritt über {step} s hält die Toleranz ein",
  "the run diverges at t = {time} s: accelerations are no longer finite numbers":
    "der Lauf divergiert bei t = {time} s: Beschleunigungen sind keine endlichen Zahlen mehr",
  "the integration stops at t = {time} s: within a step of {step} s the turning of a joint changes so much that its whole turns are not known":
    "die Integration endet bei t = {time} s: Innerhalb eines Schritts von {step} s ändert sich die Drehung eines Gelenks so sehr, dass seine ganzen Umdrehungen nicht bekannt sind",
  "the integration stops at t = {time} s: the equations of a step of {step} s cannot be solved":
    "die Integration endet bei t = {time} s: Die Gleichungen eines Schritts von {step} s lassen sich nicht lösen",
  "the run stalls at t = {time} s: its steps have shrunk to {step} s, and more than 1e9 of them are left":
    "der Lauf bleibt bei t = {time} s stecken: Seine Schritte sind auf {step} s geschrumpft, und mehr als 1e9 davon stehen noch aus",
  "at t = {time} s no independent coordinates can be chosen: a singular position leaves open what is free to move":
    "bei t = {time} s lassen sich keine unabhängigen Koordinaten wählen: Eine singuläre Lage lässt offen, was sich frei bewegt",
  "the numbers of the run were changed at t = {time} s: estimated errors are those of then with what has come since; how those of then grow is not known":
    "die Zahlen des Laufs wurden bei t = {time} s geändert: Geschätzte Fehler sind die von damals mit dem, was seither dazukam; wie die von damals wachsen, ist nicht bekannt",
  "the run was taken up again at t = {time} s: estimated errors are those of then with what has come since; how those of then grow is not known":
    "der Lauf wurde bei t = {time} s wieder aufgenommen: Geschätzte Fehler sind die von damals mit dem, was seither dazukam; wie die von damals wachsen, ist nicht bekannt",
  "at t = {time} s, when the numbers of the run were changed: {reason}":
    "bei t = {time} s, als die Zahlen des Laufs geändert wurden: {reason}",
  "the run cannot go on with these numbers: {reason}":
    "der Lauf kann mit diesen Zahlen nicht weitergehen: {reason}",
  "steps of {size} s in place of {asked} s: those of rattle have one size and end with the run":
    "Schritte von {size} s statt {asked} s: Die von rattle haben eine einzige Länge und enden mit dem Lauf",
  'steps of {size} s: the trial that finds their size begins with them, and the tolerance, which allows longer ones, changes nothing; "step" gives another size':
    "Schritte von {size} s: Der Probelauf, der ihre Länge bestimmt, beginnt damit, und die Toleranz, die längere erlaubt, ändert nichts; „step“ gibt eine andere Länge",
  "the run stops at t = {time} s: its {steps} steps are used up":
    "der Lauf endet bei t = {time} s: Seine {steps} Schritte sind verbraucht",
  "t = {time} s is outside the run, which goes from {from} s to {to} s":
    "t = {time} s liegt außerhalb des Laufs, der von {from} s bis {to} s geht",
  "{reason} (after {steps} step)": "{reason} (nach {steps} Schritt)",
  "{reason} (after {steps} steps)": "{reason} (nach {steps} Schritten)",
  "{reason} (after {steps} step; {cause})": "{reason} (nach {steps} Schritt; {cause})",
  "{reason} (after {steps} steps; {cause})": "{reason} (nach {steps} Schritten; {cause})",
  "driver {drivers} asks for more than the joints allow: at t = {time} s no position nearby closes {open}":
    "Antrieb {drivers} verlangt mehr, als die Gelenke erlauben: Bei t = {time} s schließt keine Lage in der Nähe {open}",
  '"{joint}" is about to lose its hold, of which {left} is left':
    "„{joint}“ verliert gleich seinen Halt, von dem {left} übrig ist",
  '"{joint}" hardly holds since the start, where others leave it {left} of a firm hold':
    "„{joint}“ hält seit dem Anfang kaum, wo ihm andere {left} eines festen Halts lassen",
  "at t = {time} s joints lend {bodies} next to no inertia in a motion that they allow: how fast it is there depends on moments of inertia that the scene leaves out":
    "bei t = {time} s leihen Gelenke {bodies} fast keine Trägheit in einer Bewegung, die sie erlauben: Wie schnell sie dort ist, hängt von Trägheitsmomenten ab, die in der Szene fehlen",
  "at t = {time} s joints lend {bodies} next to no inertia in a motion that they allow: how fast it is there depends on moments of inertia that the scene leaves out; give them some about every axis":
    "bei t = {time} s leihen Gelenke {bodies} fast keine Trägheit in einer Bewegung, die sie erlauben: Wie schnell sie dort ist, hängt von Trägheitsmomenten ab, die in der Szene fehlen; gib ihnen um jede Achse welche",
  'the friction of "{load}" locks: it presses its joint together faster than it can hold, and no motion satisfies both':
    "die Reibung von „{load}“ klemmt: Sie presst ihr Gelenk schneller zusammen, als es halten kann, und keine Bewegung erfüllt beides",

  "{integrator} cannot run this scene: it is the partner of the augmented Lagrangian alone":
    "{integrator} kann diese Szene nicht rechnen: Es gehört allein zur erweiterten Lagrange-Methode",
  "Ask for the stabilization augmented-lagrangian, which brings it along, or leave the integrator to auto.":
    "Nimm als Stabilisierung augmented-lagrangian, die es mitbringt, oder überlass den Integrator auto.",
  "which reactions are unique is not found for {rows} redundant rows among {all}: the work grows with the square of the one times the other":
    "welche Reaktionen eindeutig sind, wird bei {rows} redundanten Zeilen unter {all} nicht ermittelt: Die Arbeit wächst mit dem Quadrat der einen mal der anderen",
  "Look at a part of the mechanism as a scene of its own.":
    "Betrachte einen Teil des Mechanismus als eigene Szene.",
  "the rows of the joints hold numbers that are not finite":
    "in den Zeilen der Gelenke stehen Zahlen, die nicht endlich sind",
  "Reset the run and stop it before the state diverges.":
    "Setz den Lauf zurück, und halt ihn an, bevor der Zustand divergiert.",

  // Notes of a scene.
  "positions violated the constraints by {violated}; bodies were moved by up to {moved} onto them":
    "Die Lagen verletzten die Zwangsbedingungen um {violated}; Körper wurden um bis zu {moved} auf sie verschoben",
  'joint "{joint}": its angle goes on at {found} rad, as drivers, gears and screws say; it stood at {given} rad':
    "Gelenk „{joint}“: Sein Winkel geht bei {found} rad weiter, wie Antriebe, Zahnräder und Schrauben es sagen; er stand bei {given} rad",
  'gear "{gear}": with "{leader}" at {given} rad, where it is stated, "{joint}" starts at {found} rad, not at the {kept} rad where its bodies are stated':
    "Zahnrad „{gear}“: Mit „{leader}“ bei {given} rad, wo es angegeben ist, beginnt „{joint}“ bei {found} rad, nicht bei den {kept} rad, wo seine Körper angegeben sind",
  "velocities violated the constraints by {rate}; they were changed by up to {changed} onto them":
    "Die Geschwindigkeiten verletzten die Zwangsbedingungen um {rate}; sie wurden um bis zu {changed} auf sie geändert",
  "velocities violated the constraints by {rate}; they were changed by up to {changed} onto them; {reason}":
    "Die Geschwindigkeiten verletzten die Zwangsbedingungen um {rate}; sie wurden um bis zu {changed} auf sie geändert; {reason}",
  'the joints do not allow the given velocities: {reason}; give rates of joints ("start") instead':
    "die Gelenke erlauben die gegebenen Geschwindigkeiten nicht: {reason}; gib stattdessen Geschwindigkeiten von Gelenken („start“)",
  'the joints do not allow the given velocities: {reason}, and {n} other bodies likewise; give rates of joints ("start") instead':
    "die Gelenke erlauben die gegebenen Geschwindigkeiten nicht: {reason}, ebenso {n} andere Körper; gib stattdessen Geschwindigkeiten von Gelenken („start“)",
  'body "{body}": of the velocity {given} m/s it keeps {kept}':
    "Körper „{body}“: Von der Geschwindigkeit {given} m/s behält er {kept}",
  'body "{body}": of the angular velocity {given} rad/s it keeps {kept}':
    "Körper „{body}“: Von der Winkelgeschwindigkeit {given} rad/s behält er {kept}",
  'joint "{joint}": {given} {unit} are given for the start, but driver "{driver}" prescribes {found} there':
    "Gelenk „{joint}“: {given} {unit} sind für den Anfang gegeben, aber der Antrieb „{driver}“ schreibt dort {found} vor",
  'joint "{joint}": {given} {unit} are given for the start, but all that is given together leaves {found}':
    "Gelenk „{joint}“: {given} {unit} sind für den Anfang gegeben, aber alles Gegebene zusammen lässt {found}",
  "the start is a singular position: {n} rows lose their hold there, and several branches of motion may begin; without a velocity that chooses one, which of them is followed is not determined":
    "Der Anfang ist eine singuläre Lage: {n} Zeilen verlieren dort ihren Halt, und mehrere Zweige der Bewegung können beginnen; ohne eine Geschwindigkeit, die einen wählt, ist nicht bestimmt, welchem gefolgt wird",
  "the start is a singular position: {n} rows lose their hold there, and several branches of motion may begin; the velocities belonged to none, and were changed by up to {changed} to those of one that is near: give velocities that choose one":
    "Der Anfang ist eine singuläre Lage: {n} Zeilen verlieren dort ihren Halt, und mehrere Zweige der Bewegung können beginnen; die Geschwindigkeiten gehörten zu keinem und wurden um bis zu {changed} zu denen eines nahen geändert: gib Geschwindigkeiten, die einen wählen",
  "the start is a singular position: {n} rows lose their hold there, and several branches of motion may begin; the velocities belong to none, and none was found near them: no motion goes on with them, and what follows is not to be trusted":
    "Der Anfang ist eine singuläre Lage: {n} Zeilen verlieren dort ihren Halt, und mehrere Zweige der Bewegung können beginnen; die Geschwindigkeiten gehören zu keinem, und in ihrer Nähe wurde keiner gefunden: Keine Bewegung geht mit ihnen weiter, und was folgt, ist nicht zu glauben",
  "loads that change with time are taken as they are at t = {t} s: {loads}":
    "Lasten, die sich mit der Zeit ändern, gelten, wie sie bei t = {t} s sind: {loads}",
  "how many modes there are depends on rounding: some motion has next to no inertia or stiffness":
    "wie viele Eigenformen es gibt, hängt vom Runden ab: Eine Bewegung hat so gut wie keine Trägheit oder Steifigkeit",
  "until bodies have moved by a thousandth of the mechanism's length, accelerations and forces are not those of the branch that is followed, which the equations hardly determine there":
    "Bis sich Körper um ein Tausendstel der Länge des Mechanismus bewegt haben, sind Beschleunigungen und Kräfte nicht die des Zweigs, dem gefolgt wird: Die Gleichungen bestimmen sie dort kaum",
  'joint "{joint}" holds what others hold, but not exactly: a motion opens it by {part} of its length, which is taken for rounding; give axes and points with all their digits, or a joint that leaves free what the others hold':
    "Gelenk „{joint}“ hält, was andere halten, aber nicht genau: Eine Bewegung öffnet es um {part} ihrer Länge, was als Rundung gilt; gib Achsen und Punkte mit allen Stellen, oder ein Gelenk, das frei lässt, was die anderen halten",
  "joints hold more than once what they hold: friction with a coefficient follows the smallest reactions that do, which need not be those of a real mechanism":
    "Gelenke halten mehrfach, was sie halten: Reibung mit einem Beiwert folgt den kleinsten Reaktionen, die es tun, und das müssen nicht die eines wirklichen Mechanismus sein",
  'body "{body}": with {n} attached masses it has {mass} kg, its centre of mass at {at}':
    "Körper „{body}“: Mit {n} angebrachten Massen hat er {mass} kg, sein Schwerpunkt liegt bei {at}",
  'body "{body}": principal moments {moments} kg m² found along {axes}':
    "Körper „{body}“: Hauptträgheitsmomente {moments} kg m², gefunden längs {axes}",
  'attached[{index}] of body "{body}": principal moments {moments} kg m² found along {axes}':
    "attached[{index}] von Körper „{body}“: Hauptträgheitsmomente {moments} kg m², gefunden längs {axes}",
  'body "{body}": directors off by {error} were made orthonormal':
    "Körper „{body}“: Direktoren, die um {error} abwichen, wurden orthonormiert",
  'body "{body}": the quaternion of norm {norm} was normalized':
    "Körper „{body}“: Das Quaternion mit dem Betrag {norm} wurde normiert",
  'joint "{joint}" shares no director: its axis is not along a principal axis of body "{body}"':
    "Gelenk „{joint}“ teilt keinen Direktor: Seine Achse liegt nicht längs einer Hauptachse von Körper „{body}“",
  'joint "{joint}" shares no director: body "{body}" is reduced; sharing a director needs full coordinates':
    "Gelenk „{joint}“ teilt keinen Direktor: Körper „{body}“ ist reduziert; dafür braucht er volle Koordinaten",

  // Doubts about a run.
  "from t = {time} s on nothing is known of the error: {reason}; {cause}":
    "Ab t = {time} s ist über den Fehler nichts bekannt: {reason}; {cause}",
  "the second solution that it is read off cannot go on":
    "die zweite Lösung, an der er abgelesen wird, kann nicht weiter",
  "it has grown beyond a twentieth of the mechanism's length":
    "er ist über ein Zwanzigstel der Länge des Mechanismus gewachsen",
  "positions are off by about {off} m, more than a hundredth of the mechanism's length of {length} m; {cause}":
    "Lagen weichen um etwa {off} m ab, mehr als ein Hundertstel der Länge des Mechanismus von {length} m; {cause}",
  "a singular position was passed at t = {time} s, through which {method} holds neither the constraints nor the branch of the motion: what follows may be wrong; {cause}":
    "Bei t = {time} s wurde eine singuläre Lage durchlaufen, in der {method} weder die Zwangsbedingungen noch den Zweig der Bewegung hält: Was folgt, kann falsch sein; {cause}",
  "{size} of the energy in play came from nowhere or went there, more than a tolerance of {tolerance} promises; {cause}":
    "{size} der beteiligten Energie kamen aus dem Nichts oder verschwanden darin, mehr als eine Toleranz von {tolerance} verspricht; {cause}",
  "{size} of the mechanism's size is how far the joints are open, more than a tolerance of {tolerance} promises; {cause}":
    "Die Gelenke sind um {size} der Größe des Mechanismus offen, mehr als eine Toleranz von {tolerance} verspricht; {cause}",
  "{size} of the lightest mass is lost in the rounding of the penalties, more than a tolerance of {tolerance} promises; {cause}":
    "{size} der leichtesten Masse gehen in der Rundung der Straffaktoren verloren, mehr als eine Toleranz von {tolerance} verspricht; {cause}",
  "tighten the tolerance, or look at a shorter time":
    "verschärf die Toleranz, oder betrachte eine kürzere Zeit",
  "use shorter steps, or leave their size to the tolerance":
    "nimm kürzere Schritte, oder überlass ihre Länge der Toleranz",
  "use projection, with taylor or dop853": "nimm Projektion, mit taylor oder dop853",
  "tighten the tolerance, or compare with another integrator":
    "verschärf die Toleranz, oder vergleiche mit einem anderen Verfahren",
  "at t = {time} s the motion passes within {apart} of a branching position of {joints}; either branch may be right: compare with taylor at a tighter tolerance, or change a length a little":
    "Bei t = {time} s geht die Bewegung im Abstand {apart} an einer Verzweigung von {joints} vorbei; jeder der Zweige kann richtig sein: Vergleiche mit taylor bei schärferer Toleranz, oder ändere eine Länge ein wenig",

  // Analyses.
  "this analysis takes at most {most} degrees of freedom, because its work grows with their cube; the scene has {freedoms}":
    "diese Analyse nimmt höchstens {most} Freiheitsgrade, denn ihre Arbeit wächst mit deren dritter Potenz; die Szene hat {freedoms}",
  'this analysis takes at most {most} degrees of freedom, because its work grows with their cube; the scene has {freedoms}, {turns} of which are turns of bodies about axes about which they have no inertia, "{body}" first':
    "diese Analyse nimmt höchstens {most} Freiheitsgrade, denn ihre Arbeit wächst mit deren dritter Potenz; die Szene hat {freedoms}, von denen {turns} Drehungen von Körpern um Achsen sind, um die sie keine Trägheit haben, zuerst „{body}“",
  "a steady motion keeps the momentum of each spin, and its search takes work that grows with the fourth power of the size: {spins} bodies that are alike around an axis, with {freedoms} degrees of freedom, are too many":
    "eine stationäre Bewegung erhält den Drehimpuls jeder Eigendrehung, und der Aufwand ihrer Suche wächst mit der vierten Potenz der Größe: {spins} um eine Achse gleiche Körper mit {freedoms} Freiheitsgraden sind zu viele",
  'no equilibrium was found: after {steps} steps a generalized force of {force} N is left, most of it on body "{body}"':
    "es wurde kein Gleichgewicht gefunden: Nach {steps} Schritten bleibt eine verallgemeinerte Kraft von {force} N, das meiste davon an Körper „{body}“",
  'there is no steady motion near the start: "{name}" does not let the bodies keep their places in one frame that turns and slides uniformly (a body may spin only about an axis around which its moments of inertia are alike)':
    "nahe dem Anfang gibt es keine stationäre Bewegung: „{name}“ lässt die Körper ihre Plätze in einem gleichförmig drehenden und gleitenden System nicht behalten (ein Körper darf sich nur um eine Achse drehen, um die seine Trägheitsmomente gleich sind)",
  'there is no steady motion near the start: where joints and drivers leave the bodies free to move as a whole, loads drive or brake them: a generalized force of {force} N is left there, most of it on body "{body}"':
    "nahe dem Anfang gibt es keine stationäre Bewegung: Wo Gelenke und Antriebe die Körper als Ganzes frei lassen, treiben oder bremsen sie Lasten: Es bleibt dort eine verallgemeinerte Kraft von {force} N, das meiste davon an Körper „{body}“",
  'there is no steady motion near the start: "{name}" does not go on as at the start: it is off by {by} after {time} s':
    "nahe dem Anfang gibt es keine stationäre Bewegung: „{name}“ geht nicht weiter wie am Anfang: Nach {time} s weicht es um {by} ab",
  'there is no steady motion near the start: what load "{load}" prescribes after {time} s is not what it prescribes at the start':
    "nahe dem Anfang gibt es keine stationäre Bewegung: Was Last „{load}“ nach {time} s vorgibt, ist nicht, was sie am Anfang vorgibt",
  'body "{body}" is free to spin about its axis through {joints}, and at t = {time} s a moment of {moment} N m turns it there: how it spins is not a matter of geometry alone':
    "Körper „{body}“ dreht sich frei um seine Achse durch {joints}, und bei t = {time} s dreht ihn dort ein Moment von {moment} N m: Wie er sich dreht, ist keine Frage der Geometrie allein",
  'body "{body}" cannot be kept in place: there is no such body':
    "Körper „{body}“ lässt sich nicht festhalten: Es gibt ihn nicht",
  "the eigenvalues of the small motions were not found":
    "die Eigenwerte der kleinen Bewegungen wurden nicht gefunden",
  "the drivers leave freedoms of motion ({freedoms}): it is not a matter of geometry alone":
    "die Antriebe lassen Freiheitsgrade übrig ({freedoms}): Das ist keine Frage der Geometrie allein",
  'the drivers leave freedoms of motion ({freedoms}; "{body}" moves most in one): it is not a matter of geometry alone':
    "die Antriebe lassen Freiheitsgrade übrig ({freedoms}; am meisten bewegt sich „{body}“): Das ist keine Frage der Geometrie allein",
  "the start is a singular position of the driven mechanism, where the rows of {joints} depend on others: several branches of the motion begin there, and the velocities do not say which is meant":
    "der Anfang ist eine singuläre Lage des angetriebenen Mechanismus, in der die Zeilen von {joints} von anderen abhängen: Mehrere Zweige der Bewegung beginnen dort, und die Geschwindigkeiten sagen nicht, welcher gemeint ist",
  "at t = {time} s driver {drivers} comes to a dead point: the bodies would have to move infinitely fast there, and no position beyond it closes {joints}":
    "bei t = {time} s kommt Antrieb {drivers} in eine Totlage: Die Körper müssten sich dort unendlich schnell bewegen, und keine Lage dahinter schließt {joints}",
  "at t = {time} s the nearest position that meets the drivers is {moved} away from the one that the motion leads to: it may be another branch":
    "bei t = {time} s liegt die nächste Lage, die den Antrieben genügt, um {moved} neben der, zu der die Bewegung führt: Es kann ein anderer Zweig sein",
  "{positions} positions are more than one analysis gives":
    "{positions} Lagen sind mehr, als eine Analyse gibt",
  "velocities of the start are left out: modes are those of the mechanism at rest; those about the steady motion at these velocities, if there is one, can be asked for":
    "Die Geschwindigkeiten des Anfangs bleiben weg: Die Eigenformen sind die des ruhenden Mechanismus; die um die stationäre Bewegung mit diesen Geschwindigkeiten, wenn es sie gibt, kann man verlangen",
  "velocities of the start are left out: they belong to no motion in which all bodies keep their places in a frame, and the steady motion near the start is rest":
    "Die Geschwindigkeiten des Anfangs bleiben weg: Sie gehören zu keiner Bewegung, in der alle Körper ihre Plätze in einem System behalten, und die stationäre Bewegung nahe dem Anfang ist die Ruhe",
  "degrees of freedom without inertia that springs hold: {held}; they follow the others at once and have no mode of their own":
    "Freiheitsgrade ohne Trägheit, die Federn halten: {held}; sie folgen den anderen sofort und haben keine eigene Eigenform",
  "springs are too different to find it: what is left of the forces, {left} N, is the rounding of the stiffest, and moves what the softest hold by up to {off} m":
    "Die Federn sind zu verschieden, um sie zu finden: Was von den Kräften bleibt, {left} N, ist die Rundung der steifsten und bewegt, was die weichsten halten, um bis zu {off} m",
  'beside the stiffest spring nothing below {stiffness} N/m is felt: load "{load}" may hold what is told as a drift':
    "Neben der steifsten Feder ist nichts unter {stiffness} N/m zu spüren: Last „{load}“ hält vielleicht, was als Drift genannt ist",
  "some motion meets no stiffness": "eine Bewegung findet keine Steifigkeit",
  "some forces have no potential, such as those that turn with a body: whether the position is stable is decided by the growth of its small motions":
    "Manche Kräfte haben kein Potential, etwa solche, die sich mit einem Körper drehen: Ob die Lage stabil ist, entscheidet das Anwachsen ihrer kleinen Bewegungen",
  "some forces have no potential, such as those that turn with a body: whether the position is stable is decided by the growth of its small motions; undecided here: its modes tell":
    "Manche Kräfte haben kein Potential, etwa solche, die sich mit einem Körper drehen: Ob die Lage stabil ist, entscheidet das Anwachsen ihrer kleinen Bewegungen; hier nicht entschieden: Die Eigenformen sagen es",
  "dry friction is left out: where it holds, positions beside this one are positions of rest as well":
    "Trockene Reibung bleibt weg: Wo sie hält, sind Lagen daneben auch Ruhelagen",
  "friction with a coefficient is left out: about a position at rest it has no linear law":
    "Reibung mit einem Beiwert bleibt weg: Um eine Ruhelage hat sie kein lineares Gesetz",
  "friction with a coefficient is left out of the forces; a run of the driven mechanism has it":
    "Reibung mit einem Beiwert fehlt in den Kräften; ein Lauf des angetriebenen Mechanismus hat sie",
  'spring "{name}" has no length at this position and a force all the same, whose direction jumps there: it has no linear law and is left out; modes about a position where its ends are apart have it':
    "Feder „{name}“ hat in dieser Lage keine Länge und doch eine Kraft, deren Richtung dort springt: Sie hat kein lineares Gesetz und bleibt weg; Eigenformen um eine Lage, in der ihre Enden auseinander sind, haben sie",
  'the damping of spring "{name}" is left out: the spring has no length at this position, and so no direction':
    "Die Dämpfung der Feder „{name}“ bleibt weg: Die Feder hat in dieser Lage keine Länge und also keine Richtung",
  "joints and drivers leave no freedom: nothing can vibrate":
    "Gelenke und Antriebe lassen keine Freiheit: Nichts kann schwingen",
  "the position is singular: {lost} rows lose their hold there, and branches of motion meet. The linear equations allow all that these rows let through: some of the modes are motions of no branch":
    "Die Lage ist singulär: {lost} Zeilen verlieren dort ihren Halt, und Zweige der Bewegung treffen sich. Die linearen Gleichungen erlauben alles, was diese Zeilen durchlassen: Einige der Eigenformen sind Bewegungen keines Zweigs",
  "the position is not an equilibrium: a generalized force of {left} N is left, which the linear equations leave out":
    "Die Lage ist kein Gleichgewicht: Eine verallgemeinerte Kraft von {left} N bleibt, die die linearen Gleichungen weglassen",
  "t = {time} s is next to a singular position: forces grow beyond all bounds there, unless what acts on the bodies happens to be in balance, and those shown are not unique":
    "t = {time} s liegt bei einer singulären Lage: Dort wachsen Kräfte über alle Grenzen, außer was auf die Körper wirkt, ist gerade im Gleichgewicht, und die gezeigten sind nicht eindeutig",
  "singular positions were passed, where other branches begin; the smooth one was followed. Where lengths differ by less than a millionth from those that make the position singular, either may be right":
    "Singuläre Lagen wurden durchlaufen, in denen andere Zweige beginnen; dem glatten wurde gefolgt. Wo Längen um weniger als ein Millionstel von denen abweichen, die die Lage singulär machen, kann jeder richtig sein",
  'body "{body}" can spin about its axis through {joints}, which moves nothing else: it keeps the {rate} rad/s about it that it starts with, as nothing turns it there':
    "Körper „{body}“ kann sich um seine Achse durch {joints} drehen, was sonst nichts bewegt: Er behält die {rate} rad/s, mit denen er beginnt, denn nichts dreht ihn dort",
  'the angle of joint "{joint}" is {angle} rad here: with these positions give it "stated_angle": {same} and no angle in its "start", or loads, gears and events count from elsewhere':
    "Der Winkel von Gelenk „{joint}“ ist hier {angle} rad: Gib ihm mit diesen Lagen „stated_angle“: {same} und keinen Winkel in „start“, sonst zählen Lasten, Zahnräder und Ereignisse von anderswo",
  "the points of {joints} are given in the world: links between them are as long as the stated positions make them, and rounded positions make wrong lengths; only point_i and point_j keep lengths":
    "Die Punkte von {joints} sind in der Welt gegeben: Glieder zwischen ihnen sind so lang, wie die angegebenen Lagen sie machen, und gerundete Lagen machen falsche Längen; nur point_i und point_j erhalten Längen",

  // What helps with analyses.
  "Look whether anything holds that body: a body that falls freely has no equilibrium. Make springs alike: where stiffnesses differ by more than 1e8, the rounding of the stiff ones hides the soft ones. Otherwise start nearer to where it comes to rest.":
    "Sieh nach, ob diesen Körper etwas hält: Ein frei fallender Körper hat kein Gleichgewicht. Mach Federn ähnlicher: Wo Steifigkeiten sich um mehr als 1e8 unterscheiden, verdeckt die Rundung der steifen die weichen. Sonst beginne näher an seiner Ruhelage.",
  'Take those turns away: in place of points on joints of the kind "rod", or of thin rods between spherical joints, let thin rods hang on revolute joints where all moves in a plane, on universal joints where it does not. Or analyse a part of the mechanism as a scene of its own.':
    "Nimm diese Drehungen weg: Statt Punkten an Gelenken der Art „rod“ oder dünnen Stäben zwischen Kugelgelenken lass dünne Stäbe an Drehgelenken hängen, wo sich alles in einer Ebene bewegt, sonst an Kreuzgelenken. Oder untersuche einen Teil des Mechanismus als eigene Szene.",
  "Analyse a part of the mechanism as a scene of its own.":
    "Untersuche einen Teil des Mechanismus als eigene Szene.",
  "Add a driver for each degree of freedom, or run the scene forward in time.":
    "Gib jedem Freiheitsgrad einen Antrieb, oder lass die Szene in der Zeit laufen.",
  "Give the bodies the velocities of the branch that is meant, or start a little before that position: it is passed on its smooth branch.":
    "Gib den Körpern die Geschwindigkeiten des Zweigs, der gemeint ist, oder beginne ein wenig vor dieser Lage: Sie wird auf ihrem glatten Zweig durchfahren.",
  "Let the driver turn back before that time, change lengths, drive another joint, or end the analysis before.":
    "Lass den Antrieb vor dieser Zeit umkehren, ändere Längen, treib ein anderes Gelenk an, oder beende die Analyse vorher.",
  "Look whether the mechanism is next to a singular position there, and change a length.":
    "Sieh nach, ob der Mechanismus dort bei einer singulären Lage ist, und ändere eine Länge.",

  "Drive at constant speed what loads drive or brake, turn about an axis along the weight, and leave out the weight of what falls freely. Modes about a position at rest are those about the equilibrium or the start.":
    "Treib mit gleicher Geschwindigkeit an, was Lasten antreiben oder bremsen, dreh um eine Achse längs der Schwerkraft, und lass die Schwerkraft weg, wenn etwas frei fällt. Eigenformen um eine Ruhelage sind die um das Gleichgewicht oder den Anfang.",
  "Look whether stiffness and damping of the loads are of a sensible size.":
    "Sieh nach, ob Steifigkeit und Dämpfung der Lasten eine sinnvolle Größe haben.",
  'Put a universal joint in place of a spherical one at one end, leave the body out by a joint of the kind "rod", or run the scene forward in time.':
    "Setz an einem Ende ein Kardangelenk an die Stelle eines Kugelgelenks, ersetz den Körper durch ein Gelenk der Art „rod“, oder lass die Szene in der Zeit laufen.",
  'Raise "every", the interval of outputs, or shorten the duration.':
    "Vergrößere „every“, den Abstand der Ausgaben, oder verkürze die Dauer.",
  "Check the name, and keep fewer bodies in place.": "Prüf den Namen, und halt weniger Körper fest.",

  // Rooms of lectures.
  "there is no lecture room {code}": "es gibt keinen Vorlesungsraum {code}",
  "check the code; the lecture may be over": "Prüf den Code; die Vorlesung kann zu Ende sein.",
  "a room cannot be named {typed}": "ein Raum kann nicht {typed} heißen",
  "write {n} to {most} letters a to z and digits, with single hyphens between: mbs-2026":
    "Schreib {n} bis {most} Buchstaben a bis z und Ziffern, mit einzelnen Bindestrichen dazwischen: mbs-2026",
  "the room {name} belongs to somebody else": "der Raum {name} gehört jemand anderem",
  "choose another name, such as one with your own or with the term; a name is opened again only by who opened it first":
    "Wähl einen anderen Namen, etwa mit deinem eigenen oder mit dem Semester; einen Namen öffnet nur wieder, wer ihn zuerst geöffnet hat.",

  // A class: policies, extensions, regrades, tables for Canvas.
  "Policy changed": "Die Regelung wurde inzwischen geändert",
  "the policy of this lesson was set anew since you read it":
    "die Regelung dieser Lektion wurde neu festgelegt, seit du sie gelesen hast",
  "nothing was changed: look at what is set now, then set yours in its place if it is still right":
    "Nichts wurde geändert: Sieh dir an, was jetzt festgelegt ist, und leg dann deine an seiner Stelle fest, wenn sie noch stimmt.",
  "Invalid policy": "Die Regelung passt nicht",
  "this cannot be set: {reason}": "das lässt sich nicht festlegen: {reason}",
  "{name} lies outside of the years 1970 to 2999": "{name} liegt außerhalb der Jahre 1970 bis 2999",
  "cooldown_minutes is more than {n}, a year": "cooldown_minutes ist mehr als {n}, ein Jahr",
  "it lies before what should come first": "es liegt vor dem, was zuerst kommen soll",
  "nothing is late without a due date": "ohne Termin ist nichts zu spät",
  "there are more than 50 steps": "es sind mehr als 50 Stufen",
  "shares go from 0 to 1": "Anteile gehen von 0 bis 1",
  "a later one counts more than the one before it": "ein späterer zählt mehr als der davor",
  "nobody could hand in": "niemand könnte abgeben",
  "there is no due date after which to tell it": "es gibt keinen Termin, nach dem es mitgeteilt würde",
  "dates lie in the years 1970 to 2999, in the order opens, due, late, closes; shares go from 0 to 1 and never rise":
    "Zeitpunkte liegen in den Jahren 1970 bis 2999, in der Folge opens, due, late, closes; Anteile gehen von 0 bis 1 und steigen nie.",
  "Invalid extension": "Die Verlängerung passt nicht",
  "it allows neither more time nor more attempts": "sie erlaubt weder mehr Zeit noch mehr Versuche",
  "give a date, or attempts, or both": "Gib einen Zeitpunkt an, oder Versuche, oder beides.",
  "it allows nothing that is not allowed to everybody": "sie erlaubt nichts, was nicht allen erlaubt ist",
  "give a date after the due date, or attempts where they are bounded":
    "Gib einen Zeitpunkt nach dem Termin an, oder Versuche, wo sie begrenzt sind.",
  "give a date within these years": "Gib einen Zeitpunkt in diesen Jahren an.",
  "Invalid decision": "Die Entscheidung passt nicht",
  "it is empty or has more than {n} characters": "der Text ist leer oder hat mehr als {n} Zeichen",
  "say in a sentence why": "Sag in einem Satz, warum.",
  "Out of date": "Die Vorschau ist veraltet",
  "something was handed in or regraded since this preview was made":
    "seit dieser Vorschau wurde etwas abgegeben oder neu bewertet",
  "points were decided since this preview was made": "seit dieser Vorschau wurde über Punkte entschieden",
  "the policy was set anew since this preview was made":
    "seit dieser Vorschau wurde die Regelung neu festgelegt",
  "an extension was given or taken back since this preview was made":
    "seit dieser Vorschau wurde eine Verlängerung gegeben oder zurückgenommen",
  "nothing was changed: make the preview anew, then apply it":
    "Nichts wurde geändert: Mach die Vorschau neu, und wende sie dann an.",
  "No canvas export": "Das kommt nicht aus Canvas",
  "this is no gradebook that Canvas exported: {reason}":
    "das ist kein Notenbuch, das Canvas exportiert hat: {reason}",
  "its first line does not begin with Student and ID": "seine erste Zeile beginnt nicht mit Student und ID",
  "in Canvas choose Grades, Export, Export Entire Gradebook, and send that file as it is":
    "Wähl in Canvas Grades, Export, Export Entire Gradebook, und sende die Datei, wie sie ist.",
};
